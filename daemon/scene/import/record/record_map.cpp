// SPDX-License-Identifier: MIT
#include "daemon/scene/import/record/record_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/record/axes.h"
#include "daemon/scene/import/record/cloud_voxels.h"

namespace camway::scene {
namespace {

namespace layout = import_record;
using geometry::Vec3;

RecordMap refused_map(std::string refusal, Limit limit = Limit::kNone) {
  RecordMap result;
  result.refusal = std::move(refusal);
  result.limit = limit;
  return result;
}

bool is_sound(const layout::Cube& cube) {
  const auto size = static_cast<std::uint32_t>(cube.size);
  if (cube.size < 1 || cube.size > VoxelGrid::kRoot.size || !std::has_single_bit(size))
    return false;
  return std::ranges::all_of(cube.min, [&](std::int32_t low) {
    return low >= VoxelGrid::kMinVoxel && low <= VoxelGrid::kMaxVoxel + 1 - cube.size &&
           (low - VoxelGrid::kMinVoxel) % cube.size == 0;
  });
}

/// As `turned`, for voxels: on a reversed axis a cube ends at the voxel before the mirrored first
/// one.
VoxelCube turned(const layout::Cube& cube, UpAxis up) {
  const auto reversed = [&](std::int32_t low) { return -(low + cube.size); };
  switch (up) {
    case UpAxis::kZToY:
      return {{cube.min[0], cube.min[2], reversed(cube.min[1])}, cube.size};
    case UpAxis::kYToZ:
      return {{cube.min[0], reversed(cube.min[2]), cube.min[1]}, cube.size};
    case UpAxis::kAsInFile:
      break;
  }
  return {cube.min, cube.size};
}

/// The voxel that begins at `origin`, if it has one that does exactly.
std::optional<Voxel> voxel_at(const Vec3& origin, double edge) {
  Voxel voxel{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = origin[static_cast<Eigen::Index>(k)];
    const double number = std::round(at / edge);
    if (!(std::abs(number) <= VoxelGrid::kMaxVoxel) || number * edge != at) return std::nullopt;
    voxel[k] = static_cast<std::int32_t>(number);
  }
  return voxel;
}

bool is_within_keys(const VoxelSet::Range& range) {
  const bool is_empty = range[0].first > range[0].last;
  return is_empty || std::ranges::all_of(range, [](const VoxelRange& along) {
           return along.first >= VoxelGrid::kMinVoxel && along.last <= VoxelGrid::kMaxVoxel;
         });
}

/// Moves voxels; nothing if one leaves the keys of OctoMap.
std::optional<VoxelSet> moved(const VoxelSet& set, const Voxel& by) {
  VoxelSet result;
  VoxelMarker marker(result);
  set.for_each([&](const Voxel& voxel) {
    marker.insert({voxel[0] + by[0], voxel[1] + by[1], voxel[2] + by[2]});
  });
  if (!is_within_keys(result.bounds())) return std::nullopt;
  return result;
}

/// The voxels of the cubes, or nothing if there are too many. Requires that all are sound.
std::optional<VoxelSet> voxels_of(const std::vector<layout::Cube>& cubes, UpAxis up,
                                  std::uint64_t most_voxels) {
  std::uint64_t voxels = 0;
  for (const layout::Cube& cube : cubes) {
    const auto edge = static_cast<std::uint64_t>(cube.size);
    voxels += edge * edge * edge;
    if (voxels > most_voxels) return std::nullopt;
  }
  VoxelSet set;
  for (const layout::Cube& cube : cubes) set.insert(turned(cube, up));
  return set;
}

/// Builds the map with its faces, at `origin_m`.
RecordMap built(double voxel_m, VoxelSet occupied, VoxelSet free, const ImportOptions& options,
                const Vec3& origin_m) {
  VoxelMapResult result = VoxelMap::build(voxel_m, std::move(occupied), std::move(free),
                                          options.unknown, options.map_limits);
  if (!result.map) return refused_map(std::move(result.error), result.limit);
  if (!result.map->faces()) {
    return refused_map(
        "has more than " + std::to_string(options.map_limits.triangles) + " triangles",
        Limit::kMapTriangles);
  }
  RecordMap map;
  map.map = std::move(result.map);
  map.origin_m = origin_m;
  return map;
}

bool is_usable(const Vec3& p) {
  // False for NaN.
  return (p.array().abs() < geometry::kLargestCoordinate_m).all();
}

/// The points of a record, in the scene's frame, and how many of its own are not finite.
struct ScenePoints {
  std::vector<Vec3> points_m;
  std::size_t not_finite = 0;
  bool is_too_far = false;
};

ScenePoints points_of(const layout::Record& record, UpAxis up, double scale) {
  ScenePoints result;
  result.points_m.reserve(record.vertices.size());
  for (const layout::Vertex& vertex : record.vertices) {
    const Vec3 point(vertex[0], vertex[1], vertex[2]);
    if (!point.allFinite()) {
      ++result.not_finite;
      continue;
    }
    const Vec3 point_m = turned(scale * point, up);
    if (!is_usable(point_m)) result.is_too_far = true;
    result.points_m.push_back(point_m);
  }
  return result;
}

RecordMap map_with_voxels_of(double voxel_m, std::span<const Vec3> points_m,
                             const ImportOptions& options) {
  base::Result<CloudVoxels> cloud = voxels_of_cloud(points_m, voxel_m);
  if (!cloud) return refused_map(std::move(cloud.error));
  return built(voxel_m, std::move(cloud->voxels), {}, options, cloud->origin_m);
}

/// The map with the voxels that suit the cloud, or with larger ones if these are too many.
RecordMap usual_map_of(std::span<const Vec3> points_m, const ImportOptions& options) {
  double voxel_m = usual_voxel_m(points_m);
  RecordMap map = map_with_voxels_of(voxel_m, points_m, options);
  bool is_limited = false;
  while (map.limit != Limit::kNone && VoxelGrid::valid_resolution(2.0 * voxel_m)) {
    is_limited = true;
    voxel_m *= 2.0;
    map = map_with_voxels_of(voxel_m, points_m, options);
  }
  map.notes.push_back(fmt::format("voxels of {} m, {}: say voxel_m to choose", voxel_m,
                                  is_limited
                                      ? "as small as the limits of a map let them be"
                                      : "about twice the median distance of neighbouring points"));
  return map;
}

}  // namespace

RecordMap map_of_cubes(const layout::Record& record, const ImportOptions& options, double scale) {
  if (!std::ranges::all_of(record.occupied, is_sound) ||
      !std::ranges::all_of(record.free, is_sound)) {
    return refused_map("has voxels that OctoMap cannot have");
  }
  const std::uint64_t most = options.map_limits.voxels;
  std::optional<VoxelSet> occupied = voxels_of(record.occupied, options.up, most);
  const bool needs_free =
      record.header.is_free_optional == 0 || options.unknown == UnknownSpace::kOccupied;
  std::optional<VoxelSet> free =
      needs_free ? voxels_of(record.free, options.up, most) : std::optional(VoxelSet());
  if (!occupied || !free) {
    return refused_map(
        "has more than " + std::to_string(most) + " voxels that are occupied or free",
        Limit::kMapVoxels);
  }
  const layout::Vertex& begin = record.header.map_origin;
  const double edge = record.header.map_resolution;
  Vec3 origin_m = turned(scale * Vec3(begin[0], begin[1], begin[2]), options.up);
  if (!is_usable(origin_m)) return refused_map("begins too far from the origin");
  const std::optional<Voxel> shift =
      voxel_at(turned(Vec3(begin[0], begin[1], begin[2]), options.up), edge);
  if (shift && *shift != Voxel{}) {
    std::optional<VoxelSet> moved_occupied = moved(*occupied, *shift);
    std::optional<VoxelSet> moved_free = moved(*free, *shift);
    if (moved_occupied && moved_free) {
      occupied = std::move(moved_occupied);
      free = std::move(moved_free);
      origin_m.setZero();
    }
  }
  return built(scale * edge, *std::move(occupied), *std::move(free), options, origin_m);
}

RecordMap map_of_cloud(const layout::Record& record, const ImportOptions& options, double scale) {
  if (options.unknown == UnknownSpace::kOccupied) {
    return refused_map(
        "is a cloud of points, which says nothing of free space: unknown must be free");
  }
  const ScenePoints points = points_of(record, options.up, scale);
  if (points.is_too_far) return refused_map("has a point too far from the origin");
  if (points.points_m.empty()) return refused_map("holds no point with finite coordinates");
  if (options.voxel_m && !VoxelGrid::valid_resolution(*options.voxel_m)) {
    return refused_map(fmt::format("voxel_m must be between {:g} and {:g}",
                                   VoxelGrid::kMinResolutionM, VoxelGrid::kMaxResolutionM));
  }
  RecordMap map = options.voxel_m ? map_with_voxels_of(*options.voxel_m, points.points_m, options)
                                  : usual_map_of(points.points_m, options);
  if (!map.map && map.limit != Limit::kNone && options.voxel_m) {
    map.refusal += fmt::format(" with voxels of {} m: say a larger voxel_m", *options.voxel_m);
  }
  if (!map.map) return map;
  map.notes.insert(map.notes.begin(),
                   fmt::format("{} points in {} voxels; what was not scanned counts as free",
                               points.points_m.size(), map.map->occupied().size()));
  if (points.not_finite > 0) {
    map.notes.push_back(
        fmt::format("{} points without finite coordinates are left out", points.not_finite));
  }
  return map;
}

}  // namespace camway::scene
