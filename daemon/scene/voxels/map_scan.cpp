// SPDX-License-Identifier: MIT
#include "daemon/scene/voxels/map_scan.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace camway::scene {
namespace {

using geometry::Vec3;
using octomap::OcTree;
using octomap::OcTreeKey;

/// OctoMap's rays have room for 100,000 voxels and are not checked for overflow.
constexpr double kMostRayVoxels = 65'000.0;

octomap::point3d single(const Vec3& point) {
  return {static_cast<float>(point.x()), static_cast<float>(point.y()),
          static_cast<float>(point.z())};
}

Voxel voxel_of(const OcTreeKey& key) {
  Voxel voxel{};
  for (unsigned k = 0; k < 3; ++k) voxel[k] = std::int32_t{key[k]} + VoxelGrid::kMinVoxel;
  return voxel;
}

/// An empty tree with the resolution and the sensor model of the map.
std::unique_ptr<OcTree> model_of(const VoxelMap& map) {
  auto model = std::make_unique<OcTree>(map.resolution_m());
  const SensorModel& sensor = map.sensor();
  model->setProbHit(sensor.hit_probability);
  model->setProbMiss(sensor.miss_probability);
  model->setClampingThresMin(sensor.least_probability);
  model->setClampingThresMax(sensor.most_probability);
  return model;
}

/// The voxels in which rays ended, and those that rays passed through; a voxel may be in both.
struct Seen {
  VoxelSet hit;
  VoxelSet passed;
};

/// As OctoMap's `computeUpdate`, whose sets of keys cost several times what the rays do.
Seen seen_in(const Scan& scan, double max_range_m, const OcTree& model) {
  Seen seen;
  VoxelMarker hit(seen.hit);
  VoxelMarker passed(seen.passed);
  octomap::KeyRay ray;
  const octomap::point3d origin = single(scan.origin_O);
  for (const Vec3& point_O : scan.points_O) {
    octomap::point3d end = single(point_O);
    const bool is_in_range = !std::isfinite(max_range_m) || (end - origin).norm() <= max_range_m;
    if (!is_in_range) {
      end = origin + (end - origin).normalized() * static_cast<float>(max_range_m);
    }
    if (model.computeRayKeys(origin, end, ray)) {
      for (const OcTreeKey& key : ray) passed.insert(voxel_of(key));
    }
    OcTreeKey key;
    if (is_in_range && model.coordToKeyChecked(end, key)) hit.insert(voxel_of(key));
  }
  return seen;
}

/// Updates log-odds as OctoMap's `updateNode` does.
class Updater {
 public:
  explicit Updater(const OcTree& model)
      : hit_(model.getProbHitLog()),
        miss_(model.getProbMissLog()),
        least_(model.getClampingThresMinLog()),
        most_(model.getClampingThresMaxLog()),
        occupied_(model.getOccupancyThresLog()) {}

  [[nodiscard]] ScannedBlock block(const VoxelMap& map, const Seen& seen, std::uint64_t key) const {
    const VoxelSet::Bits hit = seen.hit.block(key);
    const VoxelSet::Bits passed = seen.passed.block(key);
    ScannedBlock block{key, map.occupied().block(key), map.free().block(key), nullptr};
    auto beliefs = std::make_shared<Beliefs>(beliefs_before(map, block));
    for (std::size_t z = 0; z < hit.size(); ++z) {
      for (std::uint64_t left = hit[z] | passed[z]; left != 0; left &= left - 1) {
        const std::uint64_t bit = left & ~(left - 1);
        float& belief = (*beliefs)[64 * z + static_cast<std::size_t>(std::countr_zero(left))];
        belief = updated(belief, (hit[z] & bit) != 0 ? hit_ : miss_);
        const bool is_occupied = belief >= occupied_;
        block.occupied[z] = is_occupied ? block.occupied[z] | bit : block.occupied[z] & ~bit;
        block.free[z] = is_occupied ? block.free[z] & ~bit : block.free[z] | bit;
      }
    }
    block.beliefs = std::move(beliefs);
    return block;
  }

 private:
  /// The log-odds of the map, or those that follow from the states of its voxels.
  [[nodiscard]] Beliefs beliefs_before(const VoxelMap& map, const ScannedBlock& block) const {
    if (const Beliefs* const known = map.beliefs(block.key)) return *known;
    Beliefs beliefs{};
    for (std::size_t i = 0; i < beliefs.size(); ++i) {
      const auto is_in = [&](const VoxelSet::Bits& bits) { return (bits[i / 64] >> i % 64 & 1U); };
      if (is_in(block.free)) beliefs[i] = least_;
      if (is_in(block.occupied)) beliefs[i] = most_;
    }
    return beliefs;
  }

  [[nodiscard]] float updated(float belief, float by) const {
    const bool is_sure = by >= 0.0F ? belief >= most_ : belief <= least_;
    return is_sure ? belief : std::clamp(belief + by, least_, most_);
  }

  float hit_;
  float miss_;
  float least_;
  float most_;
  float occupied_;
};

/// Why the scan is refused; without an error if it is not.
VoxelMapResult fault_of(const VoxelMap& map, const Scan& scan, double most_voxels) {
  const VoxelGrid grid(map.resolution_m());
  // One voxel less than there are, because single precision rounds on its own.
  const double reach_m = (VoxelGrid::kMaxVoxel - 1) * map.resolution_m();
  const auto fits = [&](const Vec3& at) { return (at.array().abs() < reach_m).all(); };
  const std::string beyond =
      "is not finite or beyond the map's keys, " + std::to_string(reach_m) + " m";
  if (!fits(scan.origin_O)) return {nullptr, "origin: " + beyond};
  double voxels = 0.0;
  for (std::size_t i = 0; i < scan.points_O.size(); ++i) {
    if (!fits(scan.points_O[i])) {
      return {nullptr, "points_m[" + std::to_string(i) + "]: " + beyond};
    }
    const Vec3 ray = scan.points_O[i] - scan.origin_O;
    const double length_m = ray.norm();
    const double longest_m = map.sensor().max_range_m;
    const double share = length_m > longest_m ? longest_m / length_m : 1.0;
    const double passed = share * ray.lpNorm<1>() / map.resolution_m() + 3.0;
    if (passed > kMostRayVoxels) {
      return {nullptr,
              "points_m[" + std::to_string(i) + "]: its ray is too long; use a lower max_range_m"};
    }
    voxels += passed;
  }
  if (voxels > most_voxels) {
    return {nullptr,
            "points_m: their rays pass more than " + std::to_string(std::llround(most_voxels)) +
                " voxels; send fewer points, or use a lower max_range_m",
            Limit::kScanVoxels};
  }
  return {};
}

}  // namespace

VoxelMapResult scanned(const VoxelMap& before, const Scan& scan, double most_voxels) {
  if (VoxelMapResult fault = fault_of(before, scan, most_voxels); !fault.error.empty()) {
    return fault;
  }
  const std::unique_ptr<const OcTree> model = model_of(before);
  const Seen seen = seen_in(scan, before.sensor().max_range_m, *model);
  const Updater updater(*model);
  // Each block once: rays often end in blocks that others pass.
  std::vector<std::uint64_t> keys = seen.passed.sorted_keys();
  for (const std::uint64_t key : seen.hit.sorted_keys()) {
    if (seen.passed.block(key) == VoxelSet::Bits{}) keys.push_back(key);
  }
  std::vector<ScannedBlock> blocks;
  blocks.reserve(keys.size());
  for (const std::uint64_t key : keys) blocks.push_back(updater.block(before, seen, key));
  return before.with(blocks);
}

}  // namespace camway::scene
