// SPDX-License-Identifier: MIT
#include "daemon/scene/mirror/mirror_voxels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "daemon/geometry/rounding.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;

/// Marks the voxels of all triangles. Returns false if there were too many or a stop was requested.
bool mark_touched(const MirrorTask& task, VoxelSet& voxels) {
  VoxelMarker marker(voxels);
  // After a stop every voxel is wanted, so that the next one touched ends the loop.
  const auto is_new = [&](const Voxel& voxel) {
    return task.stop.stop_requested() || !marker.contains(voxel);
  };
  const auto mark = [&](const Voxel& voxel) {
    marker.insert(voxel);
    return voxels.size() <= task.max_voxels && !task.stop.stop_requested();
  };
  for (const Mesh* mesh : task.meshes) {
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
      if (task.stop.stop_requested()) return false;
      if (!for_each_voxel_touched(task.grid, mesh->triangle(i), is_new, mark)) return false;
    }
  }
  return true;
}

/// Adds the voxels of a grid whose centre is inside a solid, cube by cube of the solid: tests all
/// voxels near full cubes, and divides others.
class Filling {
 public:
  Filling(const MirrorTask& task, VoxelSet& voxels)
      : task_(task), solid_(*task.solid), voxels_(voxels), marker_(voxels) {
    const Vec3 farthest_W =
        solid_.bounds_W.min().cwiseAbs().cwiseMax(solid_.bounds_W.max().cwiseAbs());
    // Corners are mapped to the world with one error, centres back with another, and a point may
    // then count as inside from up to two errors away on each axis of the map: less than six in any
    // direction. A quarter of a voxel exceeds the error of the grid's own faces.
    constexpr double kErrors = 6.0;
    const double reach_m = farthest_W.lpNorm<1>() + solid_.placement.position_W().lpNorm<1>();
    error_m_ = kErrors * solid_.placement.error_m(reach_m);
  }

  /// Returns false as `mark_touched` does.
  bool run() {
    bool goes_on = true;
    solid_.map->solid().for_each_block([&](const Voxel& low, const VoxelSet::Bits& bits) {
      goes_on = goes_on && fill({low, BlockKey::kBlockSize}, bits);
    });
    return goes_on;
  }

 private:
  /// Adds the voxels with their centre in `cube`, which lies in the block with these `bits`.
  bool fill(const VoxelCube& cube, const VoxelSet::Bits& bits) {
    const std::uint64_t full =
        std::uint64_t(cube.size) * std::uint64_t(cube.size) * std::uint64_t(cube.size);
    const std::uint64_t solid_voxels = voxels_of(cube, bits);
    if (solid_voxels == 0) return true;
    const std::optional<VoxelSet::Range> near = middles_near(cube);
    if (!near) return true;
    if (solid_voxels == full) return take(*near);
    for (unsigned index = 0; index < 8; ++index) {
      if (!fill(cube.child(index), bits)) return false;
    }
    return true;
  }

  static std::uint64_t voxels_of(const VoxelCube& cube, const VoxelSet::Bits& bits) {
    const auto at = [&](std::size_t axis) { return static_cast<unsigned>(cube.min[axis] & 7); };
    const std::uint64_t row = ((std::uint64_t{1} << cube.size) - 1) << at(0);
    std::uint64_t layer = 0;
    for (std::int32_t y = 0; y < cube.size; ++y) {
      layer |= row << (8U * (at(1) + static_cast<unsigned>(y)));
    }
    std::uint64_t count = 0;
    for (std::int32_t z = 0; z < cube.size; ++z) {
      count +=
          static_cast<std::uint64_t>(std::popcount(bits[at(2) + static_cast<unsigned>(z)] & layer));
    }
    return count;
  }

  /// A range that contains all voxels of the grid whose centre is in that cube of the solid;
  /// nothing if there are none.
  [[nodiscard]] std::optional<VoxelSet::Range> middles_near(const VoxelCube& cube) const {
    Box box_W;
    for (int corner = 0; corner < 8; ++corner) {
      Vec3 corner_O;
      for (int axis = 0; axis < 3; ++axis) {
        const int end = corner >> axis & 1;
        corner_O[axis] = (cube.min[static_cast<std::size_t>(axis)] + end * cube.size) *
                         solid_.map->resolution_m();
      }
      box_W.extend(solid_.placement.to_world(corner_O));
    }
    VoxelSet::Range range;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      const double low_m = std::max(box_W.min()[i] - error_m_, solid_.bounds_W.min()[i]);
      const double high_m = std::min(box_W.max()[i] + error_m_, solid_.bounds_W.max()[i]);
      constexpr double kSlack = 0.25;
      const double first = std::ceil(low_m / task_.grid.resolution_m() - 0.5 - kSlack);
      const double last = std::floor(high_m / task_.grid.resolution_m() - 0.5 + kSlack);
      if (!(first <= last)) return std::nullopt;
      range[axis] = {static_cast<std::int32_t>(first), static_cast<std::int32_t>(last)};
    }
    return range;
  }

  bool take(const VoxelSet::Range& range) {
    Voxel voxel{};
    for (voxel[2] = range[2].first; voxel[2] <= range[2].last; ++voxel[2]) {
      for (voxel[1] = range[1].first; voxel[1] <= range[1].last; ++voxel[1]) {
        if (task_.stop.stop_requested()) return false;
        for (voxel[0] = range[0].first; voxel[0] <= range[0].last; ++voxel[0]) {
          if (!marker_.contains(voxel) && solid_.holds(task_.grid.box({voxel, 1}).center())) {
            marker_.insert(voxel);
          }
        }
        if (voxels_.size() > task_.max_voxels) return false;
      }
    }
    return true;
  }

  const MirrorTask& task_;
  const PlacedVoxelMap& solid_;
  VoxelSet& voxels_;
  VoxelMarker marker_;
  double error_m_ = 0.0;
};

double largest_triangle_m2(const MirrorTask& task) {
  double largest_m2 = 0.0;
  for (const Mesh* mesh : task.meshes) {
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
      if (task.stop.stop_requested()) return largest_m2;
      const geometry::Triangle t = mesh->triangle(i);
      largest_m2 = std::max(largest_m2, 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm());
    }
  }
  return largest_m2;
}

/// The number of voxels whose boxes have the volume of the solid. The boxes are larger than voxels,
/// because each of the six faces is moved outwards for rounding.
double room_in_voxels(const PlacedVoxelMap& solid, const VoxelGrid& grid) {
  const double edge = solid.map->resolution_m() / grid.resolution_m();
  const double larger = 1.0 + 2.0 * grid.face_error_m(VoxelGrid::kMinVoxel) / grid.resolution_m();
  return static_cast<double>(solid.map->solid().size()) * std::pow(edge / larger, 3);
}

}  // namespace

double least_voxels(const MirrorTask& task) {
  const double resolution_m = task.grid.resolution_m();
  const double of_triangle =
      largest_triangle_m2(task) / (std::numbers::sqrt2 * resolution_m * resolution_m);
  return task.solid ? std::max(of_triangle, room_in_voxels(*task.solid, task.grid)) : of_triangle;
}

MirrorVoxels mirror_voxels(const MirrorTask& task) {
  MirrorVoxels result;
  if (least_voxels(task) <= static_cast<double>(task.max_voxels)) {
    VoxelSet voxels;
    if (mark_touched(task, voxels) && (!task.solid || Filling(task, voxels).run())) {
      result.voxels = std::move(voxels);
    }
  }
  result.is_cancelled = !result.voxels && task.stop.stop_requested();
  return result;
}

}  // namespace camway::scene
