// SPDX-License-Identifier: MIT
#include "daemon/scene/voxels/voxel_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "daemon/geometry/rounding.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;

/// Error of a quotient by the resolution, and of a voxel's face, in units of 2^-53 of a coordinate:
/// 1 each, and 2 for the sums about them. Doubled.
constexpr double kVoxelRoundoffs = 8.0;

/// The voxels on one axis that a point within `error_m` of a coordinate can be in.
VoxelRange voxels_near(double coordinate_m, double error_m, double resolution_m) {
  const double off_m =
      error_m + kVoxelRoundoffs * geometry::kUnitRoundoff * (std::abs(coordinate_m) + resolution_m);
  const auto voxel = [&](double at_m) {
    const double most = VoxelSet::kMostVoxels;
    return static_cast<std::int32_t>(std::clamp(std::floor(at_m / resolution_m), -most, most));
  };
  return {voxel(coordinate_m - off_m), voxel(coordinate_m + off_m)};
}

void extend(VoxelSet::Range& range, const VoxelSet::Range& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    range[axis].first = std::min(range[axis].first, other[axis].first);
    range[axis].last = std::max(range[axis].last, other[axis].last);
  }
}

VoxelSet::Range with_a_layer_about(VoxelSet::Range range) {
  for (VoxelRange& along : range) {
    --along.first;
    ++along.last;
  }
  return range;
}

bool is_empty(const VoxelSet::Range& range) { return range[0].first > range[0].last; }

double volume(const VoxelSet::Range& range) {
  double voxels = 1.0;
  for (const VoxelRange& along : range) voxels *= double{1} + along.last - along.first;
  return voxels;
}

/// Compares bits: 0 and -0 differ.
bool are_same(const std::shared_ptr<const Beliefs>& a, const std::shared_ptr<const Beliefs>& b) {
  return a == b || (a && b && std::memcmp(a->data(), b->data(), sizeof *a) == 0);
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
                               const SensorModel& sensor) {
  if (!VoxelGrid::valid_resolution(resolution_m)) {
    return {nullptr, "has a resolution that is not between 1e-9 and 1e9 m"};
  }
  std::shared_ptr<VoxelMap> map(
      new VoxelMap(resolution_m, std::move(occupied), std::move(free), unknown));
  map->limits_ = limits;
  map->sensor_ = sensor;
  if (unknown == UnknownSpace::kOccupied) {
    extend(map->known_, map->occupied_.bounds());
    extend(map->known_, map->free_.bounds());
  }
  if (std::string fault = map->fault(); !fault.empty()) {
    return {nullptr, std::move(fault), Limit::kMapVoxels};
  }
  map->fill_beyond(VoxelSet::kNoVoxels);
  map->faces_ = VoxelFaces::of(map->solid(), resolution_m, limits.triangles);
  return {std::move(map), ""};
}

VoxelMapResult VoxelMap::with(std::span<const ScannedBlock> blocks) const {
  std::shared_ptr<VoxelMap> next(new VoxelMap(*this));
  for (const ScannedBlock& block : blocks) {
    next->occupied_.set_block(block.key, block.occupied);
    next->free_.set_block(block.key, block.free);
    if (block.beliefs || beliefs(block.key) != nullptr) {
      next->beliefs_.at(block.key) = block.beliefs;
    }
    if (unknown_ == UnknownSpace::kFree) continue;
    VoxelSet::extend(next->known_, block.key, block.occupied);
    VoxelSet::extend(next->known_, block.key, block.free);
  }
  if (std::string fault = next->fault(); !fault.empty()) {
    return {nullptr, std::move(fault), Limit::kMapVoxels};
  }
  if (unknown_ == UnknownSpace::kOccupied) {
    for (const ScannedBlock& block : blocks) next->fill(block.key);
    next->fill_beyond(box());
  }
  next->faces_ = faces_ ? faces_->updated(solid(), next->solid(), resolution_m_, limits_.triangles)
                        : VoxelFaces::of(next->solid(), resolution_m_, limits_.triangles);
  return {std::move(next), ""};
}

std::vector<ScannedBlock> VoxelMap::blocks_changed_since(const VoxelMap& before) const {
  std::vector<std::uint64_t> keys;
  const auto note = [&](std::uint64_t key, const VoxelSet::Bits&, const VoxelSet::Bits&) {
    keys.push_back(key);
  };
  occupied_.for_each_difference(before.occupied_, note);
  free_.for_each_difference(before.free_, note);
  beliefs_.for_each_unshared(
      before.beliefs_, [&](std::uint64_t key, const auto* theirs, const auto* ours) {
        const std::shared_ptr<const Beliefs> none;
        const bool is_same =
            are_same(theirs != nullptr ? *theirs : none, ours != nullptr ? *ours : none);
        if (!is_same) keys.push_back(key);
      });
  std::ranges::sort(keys);
  // Not std::ranges::unique: Clang 14 cannot compile that of GCC 12's library.
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<ScannedBlock> blocks;
  blocks.reserve(keys.size());
  for (const std::uint64_t key : keys) {
    const std::shared_ptr<const Beliefs>* const found = beliefs_.find(key);
    blocks.push_back({key, occupied_.block(key), free_.block(key),
                      found != nullptr ? *found : std::shared_ptr<const Beliefs>()});
  }
  return blocks;
}

/// Why such a map is refused, or an empty text.
std::string VoxelMap::fault() const {
  if (occupied_.size() > limits_.voxels || free_.size() > limits_.voxels) {
    return too_many(limits_, "occupied or free voxels");
  }
  if (!is_empty(known_) && volume(box()) > static_cast<double>(limits_.voxels)) {
    return too_many(limits_, "voxels in its box, which the unknown fills");
  }
  return {};
}

/// The box that unknown space fills; no voxels if nothing is known.
VoxelSet::Range VoxelMap::box() const {
  return is_empty(known_) ? known_ : with_a_layer_about(known_);
}

void VoxelMap::fill(std::uint64_t key) {
  VoxelSet::Bits bits = VoxelSet::bits_in(box(), key);
  const VoxelSet::Bits free = free_.block(key);
  const VoxelSet::Bits occupied = occupied_.block(key);
  for (std::size_t z = 0; z < bits.size(); ++z) bits[z] = (bits[z] & ~free[z]) | occupied[z];
  solid_.set_block(key, bits);
}

/// Fills all blocks of the box that do not lie in the former box `before`.
void VoxelMap::fill_beyond(const VoxelSet::Range& before) {
  constexpr std::int32_t kStep = BlockKey::kBlockSize;
  const VoxelSet::Range now = box();
  if (is_empty(now)) return;
  const auto lies_in = [&](std::size_t axis, std::int32_t low) {
    return before[axis].first <= low && low + kStep - 1 <= before[axis].last;
  };
  const auto first = [&](std::size_t axis) { return now[axis].first & ~(kStep - 1); };
  for (std::int32_t z = first(2); z <= now[2].last; z += kStep) {
    for (std::int32_t y = first(1); y <= now[1].last; y += kStep) {
      const bool is_row_inside = lies_in(2, z) && lies_in(1, y);
      for (std::int32_t x = first(0); x <= now[0].last; x += kStep) {
        if (!is_row_inside || !lies_in(0, x)) fill(BlockKey::of({x, y, z}));
      }
    }
  }
}

std::uint64_t VoxelMap::memory_bytes() const {
  return occupied_.memory_bytes() + free_.memory_bytes() + solid_.memory_bytes() +
         beliefs_.memory_bytes() + beliefs_.size() * sizeof(Beliefs);
}

std::uint64_t VoxelMap::memory_bytes_beside(const VoxelMap& other) const {
  std::uint64_t bytes =
      occupied_.memory_bytes_beside(other.occupied_) + free_.memory_bytes_beside(other.free_) +
      solid_.memory_bytes_beside(other.solid_) + beliefs_.memory_bytes_beside(other.beliefs_);
  beliefs_.for_each_unshared(
      other.beliefs_, [&](std::uint64_t, const auto* theirs, const auto* ours) {
        const bool is_shared = theirs != nullptr && ours != nullptr && *theirs == *ours;
        if (ours != nullptr && !is_shared) bytes += sizeof(Beliefs);
      });
  return bytes;
}

bool VoxelMap::is_solid_near(const Vec3& point_O, double error_m) const {
  if (!point_O.allFinite()) return true;
  VoxelSet::Range near;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    near[axis] = voxels_near(point_O[static_cast<Eigen::Index>(axis)], error_m, resolution_m_);
  }
  // The error is several voxels: doubles cannot resolve coordinates there.
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
  // One error for the faces, mapped to the world, and one for the point, mapped back.
  const double reach_m =
      std::max(point_W.lpNorm<1>(), (point_W - placement.position_W()).lpNorm<1>());
  return map->is_solid_near(placement.to_object(point_W), 2.0 * placement.error_m(reach_m));
}

bool SceneSolids::hold(const Vec3& point_W) const {
  return std::ranges::any_of(maps_, [&](const auto& map) { return map.holds(point_W); });
}

}  // namespace camway::scene
