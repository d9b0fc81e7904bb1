// SPDX-License-Identifier: MIT
#include "daemon/scene/voxels/voxel_grid.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "daemon/geometry/triangle_box.h"

namespace camway::scene {
namespace {

using VoxelRanges = std::array<VoxelRange, 3>;

bool outside(const VoxelCube& cube, const VoxelRanges& ranges) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (cube.min[axis] > ranges[axis].last || cube.min[axis] + cube.size <= ranges[axis].first) {
      return true;
    }
  }
  return false;
}

/// The smallest aligned cube that holds all `ranges`.
VoxelCube enclosing_cube(const VoxelRanges& ranges) {
  std::uint32_t differing = 0;
  std::array<std::uint32_t, 3> first{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] = static_cast<std::uint32_t>(ranges[axis].first - VoxelGrid::kMinVoxel);
    differing |= first[axis] ^ static_cast<std::uint32_t>(ranges[axis].last - VoxelGrid::kMinVoxel);
  }
  const std::uint32_t size = std::uint32_t{1} << std::bit_width(differing);
  VoxelCube cube;
  cube.size = static_cast<std::int32_t>(size);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cube.min[axis] = static_cast<std::int32_t>(first[axis] & ~(size - 1)) + VoxelGrid::kMinVoxel;
  }
  return cube;
}

/// Descends through the cubes that a triangle touches.
class Descent {
 public:
  Descent(const VoxelGrid& grid, const geometry::Triangle& triangle, const VoxelRanges& ranges,
          const std::function<bool(const Voxel&)>& wanted,
          const std::function<bool(const Voxel&)>& visit)
      : grid_(grid), triangle_(triangle), ranges_(ranges), wanted_(wanted), visit_(visit) {}

  /// Tests every voxel of the ranges.
  bool run_through() const {
    Voxel voxel{};
    for (voxel[2] = ranges_[2].first; voxel[2] <= ranges_[2].last; ++voxel[2]) {
      for (voxel[1] = ranges_[1].first; voxel[1] <= ranges_[1].last; ++voxel[1]) {
        for (voxel[0] = ranges_[0].first; voxel[0] <= ranges_[0].last; ++voxel[0]) {
          if (!run({voxel, 1})) return false;
        }
      }
    }
    return true;
  }

  bool run(const VoxelCube& cube) const {
    if (outside(cube, ranges_)) return true;
    if (cube.size == 1 && !wanted_(cube.min)) return true;
    if (!geometry::triangle_touches_box(triangle_, grid_.box(cube))) return true;
    if (cube.size == 1) return visit_(cube.min);
    for (unsigned index = 0; index < 8; ++index) {
      if (!run(cube.child(index))) return false;
    }
    return true;
  }

 private:
  const VoxelGrid& grid_;
  const geometry::Triangle& triangle_;
  const VoxelRanges& ranges_;
  const std::function<bool(const Voxel&)>& wanted_;
  const std::function<bool(const Voxel&)>& visit_;
};

/// For fewer voxels the descent from an enclosing cube costs more than it saves.
constexpr std::int64_t kFewVoxels = 64;

std::int64_t voxels_in(const VoxelRanges& ranges) {
  std::int64_t voxels = 1;
  for (const VoxelRange& range : ranges) voxels *= std::int64_t{1} + range.last - range.first;
  return voxels;
}

}  // namespace

VoxelCube VoxelCube::child(unsigned index) const {
  const std::int32_t half = size / 2;
  VoxelCube result{min, half};
  for (unsigned axis = 0; axis < 3; ++axis) {
    if ((index >> axis & 1U) != 0) result.min[axis] += half;
  }
  return result;
}

bool VoxelGrid::valid_resolution(double resolution_m) {
  return resolution_m >= kMinResolutionM && resolution_m <= kMaxResolutionM;
}

VoxelGrid::VoxelGrid(double resolution_m)
    : resolution_m_(resolution_m), voxels_per_m_(1.0 / resolution_m) {
  assert(valid_resolution(resolution_m));
}

std::optional<std::int32_t> VoxelGrid::voxel_of(double coordinate_m) const {
  const double index = std::floor(voxels_per_m_ * coordinate_m);
  if (!(index >= kMinVoxel && index <= kMaxVoxel)) return std::nullopt;
  return static_cast<std::int32_t>(index);
}

std::optional<Voxel> VoxelGrid::voxel_of(const geometry::Vec3& point) const {
  const std::optional<std::int32_t> x = voxel_of(point.x());
  const std::optional<std::int32_t> y = voxel_of(point.y());
  const std::optional<std::int32_t> z = voxel_of(point.z());
  if (!x || !y || !z) return std::nullopt;
  return Voxel{*x, *y, *z};
}

geometry::Box VoxelGrid::box(const VoxelCube& cube) const {
  geometry::Vec3 low;
  geometry::Vec3 high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int32_t first = cube.min[axis];
    const std::int32_t end = first + cube.size;
    low[static_cast<Eigen::Index>(axis)] = low_face_m(first);
    high[static_cast<Eigen::Index>(axis)] = high_face_m(end);
  }
  return {low, high};
}

std::optional<VoxelRange> voxels_touching(const VoxelGrid& grid, double low_m, double high_m) {
  const std::optional<std::int32_t> low = grid.voxel_of(low_m);
  const std::optional<std::int32_t> high = grid.voxel_of(high_m);
  if (!low || !high) return std::nullopt;
  // A coordinate on a face, or within its error, belongs to the voxel beyond the face as well.
  const double face_below_m = *low * grid.resolution_m() + grid.face_error_m(*low);
  const std::int32_t above = *high + 1;
  const double face_above_m = above * grid.resolution_m() - grid.face_error_m(above);
  const VoxelRange range{low_m <= face_below_m ? *low - 1 : *low,
                         high_m >= face_above_m ? above : *high};
  if (range.first < VoxelGrid::kMinVoxel || range.last > VoxelGrid::kMaxVoxel) return std::nullopt;
  return range;
}

bool for_each_voxel_touched(const VoxelGrid& grid, const geometry::Triangle& triangle,
                            const std::function<bool(const Voxel&)>& wanted,
                            const std::function<bool(const Voxel&)>& visit) {
  const geometry::Box box = geometry::bounds(triangle);
  VoxelRanges ranges;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Eigen::Index i = static_cast<Eigen::Index>(axis);
    const std::optional<VoxelRange> range = voxels_touching(grid, box.min()[i], box.max()[i]);
    if (!range) return false;
    ranges[axis] = *range;
  }
  const Descent descent(grid, triangle, ranges, wanted, visit);
  return voxels_in(ranges) <= kFewVoxels ? descent.run_through()
                                         : descent.run(enclosing_cube(ranges));
}

bool for_each_voxel_touched(const VoxelGrid& grid, const geometry::Triangle& triangle,
                            const std::function<bool(const Voxel&)>& visit) {
  return for_each_voxel_touched(
      grid, triangle, [](const Voxel&) { return true; }, visit);
}

}  // namespace camway::scene
