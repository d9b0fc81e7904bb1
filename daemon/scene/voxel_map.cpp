// SPDX-License-Identifier: MIT
#include "daemon/scene/voxel_map.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/geometry/rounding.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;

/// Units of 2^-53 of a coordinate that a quotient by the resolution, and a face of a voxel, are
/// off: 1 each, and 2 for the sums about them. Doubled.
constexpr double kVoxelRoundoffs = 8.0;

/// The voxels on one axis that something within `error_m` of a coordinate can be in.
VoxelRange voxels_near(double coordinate_m, double error_m, double resolution_m) {
  const double off_m =
      error_m + kVoxelRoundoffs * geometry::kUnitRoundoff * (std::abs(coordinate_m) + resolution_m);
  const auto voxel = [&](double at_m) {
    const double most = VoxelSet::kMostVoxels;
    return static_cast<std::int32_t>(std::clamp(std::floor(at_m / resolution_m), -most, most));
  };
  return {voxel(coordinate_m - off_m), voxel(coordinate_m + off_m)};
}

VoxelSet::Range joined(const VoxelSet& a, const VoxelSet& b) {
  if (a.empty()) return b.bounds();
  if (b.empty()) return a.bounds();
  VoxelSet::Range range = a.bounds();
  const VoxelSet::Range other = b.bounds();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    range[axis].first = std::min(range[axis].first, other[axis].first);
    range[axis].last = std::max(range[axis].last, other[axis].last);
  }
  return range;
}

VoxelSet::Range with_a_layer_about(VoxelSet::Range range) {
  for (VoxelRange& along : range) {
    --along.first;
    ++along.last;
  }
  return range;
}

double volume(const VoxelSet::Range& range) {
  double voxels = 1.0;
  for (const VoxelRange& along : range) voxels *= double{1} + along.last - along.first;
  return voxels;
}

std::string too_many(const VoxelMapLimits& limits, const char* what) {
  return "has more than " + std::to_string(limits.voxels) + " " + what + "; use a coarser map";
}

}  // namespace

std::string fault_in(const SensorModel& sensor) {
  const auto above_half = [](double p) { return p > 0.5 && p < 1.0; };
  const auto below_half = [](double p) { return p > 0.0 && p < 0.5; };
  if (!above_half(sensor.hit_probability)) return "hit_probability: must be above 0.5 and below 1";
  if (!below_half(sensor.miss_probability))
    return "miss_probability: must be above 0 and below 0.5";
  if (!below_half(sensor.least_probability)) {
    return "least_probability: must be above 0 and below 0.5";
  }
  if (!above_half(sensor.most_probability))
    return "most_probability: must be above 0.5 and below 1";
  return sensor.max_range_m > 0.0 ? "" : "max_range_m: must be above 0";
}

VoxelMap::VoxelMap(double resolution_m, VoxelSet occupied, VoxelSet free, UnknownSpace unknown)
    : resolution_m_(resolution_m),
      unknown_(unknown),
      occupied_(std::move(occupied)),
      free_(std::move(free)) {}

VoxelMapResult VoxelMap::build(double resolution_m, VoxelSet occupied, VoxelSet free,
                               UnknownSpace unknown, const VoxelMapLimits& limits,
                               const SensorModel& sensor,
                               std::shared_ptr<const octomap::OcTree> beliefs) {
  if (!VoxelGrid::valid_resolution(resolution_m)) {
    return {nullptr, "has a resolution that is not between 1e-9 and 1e9 m"};
  }
  if (occupied.size() > limits.voxels || free.size() > limits.voxels) {
    return {nullptr, too_many(limits, "occupied or free voxels"), Limit::kMapVoxels};
  }
  std::shared_ptr<VoxelMap> map(
      new VoxelMap(resolution_m, std::move(occupied), std::move(free), unknown));
  map->limits_ = limits;
  map->sensor_ = sensor;
  map->beliefs_ = std::move(beliefs);
  const bool knows_something = !map->occupied_.empty() || !map->free_.empty();
  if (unknown == UnknownSpace::kOccupied && knows_something) {
    const VoxelSet::Range range = with_a_layer_about(joined(map->occupied_, map->free_));
    if (volume(range) > static_cast<double>(limits.voxels)) {
      return {nullptr, too_many(limits, "voxels in its box, which the unknown fills"),
              Limit::kMapVoxels};
    }
    map->solid_ = map->free_.complement_in(range);
    map->occupied_.for_each([&](const Voxel& voxel) { map->solid_.insert(voxel); });
  }
  return {std::move(map), ""};
}

std::uint64_t VoxelMap::memory_bytes() const {
  return occupied_.memory_bytes() + free_.memory_bytes() + solid_.memory_bytes() +
         (beliefs_ ? beliefs_->memoryUsage() : 0);
}

bool VoxelMap::is_solid_near(const Vec3& point_O, double error_m) const {
  if (!point_O.allFinite()) return true;
  VoxelSet::Range near;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    near[axis] = voxels_near(point_O[static_cast<Eigen::Index>(axis)], error_m, resolution_m_);
  }
  // An error of several voxels: coordinates that doubles cannot tell apart there.
  if (volume(near) > 64.0) return true;
  Voxel voxel{};
  for (voxel[2] = near[2].first; voxel[2] <= near[2].last; ++voxel[2]) {
    for (voxel[1] = near[1].first; voxel[1] <= near[1].last; ++voxel[1]) {
      for (voxel[0] = near[0].first; voxel[0] <= near[0].last; ++voxel[0]) {
        if (solid().contains(voxel)) return true;
      }
    }
  }
  return false;
}

bool PlacedVoxelMap::holds(const Vec3& point_W) const {
  if (point_W.allFinite() && !bounds_W.contains(point_W)) return false;
  // Of the faces on their way into the world, and of the point on its way back.
  const double reach_m =
      std::max(point_W.lpNorm<1>(), (point_W - placement.position_W()).lpNorm<1>());
  return map->is_solid_near(placement.to_object(point_W), 2.0 * placement.error_m(reach_m));
}

bool SceneSolids::hold(const Vec3& point_W) const {
  return std::ranges::any_of(maps_, [&](const auto& map) { return map.holds(point_W); });
}

}  // namespace camway::scene
