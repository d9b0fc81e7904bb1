// SPDX-License-Identifier: MIT
#include "daemon/scene/map_scan.h"

#include <octomap/OcTree.h>

#include <cmath>
#include <string>
#include <utility>

namespace camway::scene {
namespace {

using geometry::Vec3;
using octomap::OcTree;
using octomap::OcTreeKey;

/// OctoMap's rays have room for 100,000 voxels and do not look whether that is enough.
constexpr double kMostRayVoxels = 65'000.0;

octomap::point3d single(const Vec3& point) {
  return {static_cast<float>(point.x()), static_cast<float>(point.y()),
          static_cast<float>(point.z())};
}

OcTreeKey key_of(const Voxel& voxel) {
  const auto key = [](std::int32_t v) {
    return static_cast<octomap::key_type>(v - VoxelGrid::kMinVoxel);
  };
  return {key(voxel[0]), key(voxel[1]), key(voxel[2])};
}

void set_model(const SensorModel& sensor, OcTree& tree) {
  tree.setProbHit(sensor.hit_probability);
  tree.setProbMiss(sensor.miss_probability);
  tree.setClampingThresMin(sensor.least_probability);
  tree.setClampingThresMax(sensor.most_probability);
}

/// What the map believes, or as much as its voxels tell.
std::unique_ptr<OcTree> beliefs_of(const VoxelMap& map) {
  if (map.beliefs()) return std::make_unique<OcTree>(*map.beliefs());
  auto tree = std::make_unique<OcTree>(map.resolution_m());
  set_model(map.sensor(), *tree);
  map.free().for_each([&](const Voxel& voxel) {
    tree->setNodeValue(key_of(voxel), tree->getClampingThresMinLog(), /*lazy_eval=*/true);
  });
  map.occupied().for_each([&](const Voxel& voxel) {
    tree->setNodeValue(key_of(voxel), tree->getClampingThresMaxLog(), /*lazy_eval=*/true);
  });
  return tree;
}

/// Why the scan cannot be taken; without an error if it can.
VoxelMapResult fault_of(const VoxelMap& map, const Scan& scan, double most_voxels) {
  const VoxelGrid grid(map.resolution_m());
  // A voxel less than there are: single precision rounds on its own.
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
  std::unique_ptr<OcTree> tree = beliefs_of(before);
  octomap::Pointcloud cloud;
  cloud.reserve(scan.points_O.size());
  for (const Vec3& point : scan.points_O) cloud.push_back(single(point));
  constexpr double kEverywhere = -1.0;
  const double range_m =
      std::isfinite(before.sensor().max_range_m) ? before.sensor().max_range_m : kEverywhere;
  tree->insertPointCloud(cloud, single(scan.origin_O), range_m, /*lazy_eval=*/true);
  tree->updateInnerOccupancy();
  tree->prune();
  VoxelSet occupied;
  VoxelSet free;
  for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
    const OcTreeKey key = leaf.getIndexKey();
    VoxelCube cube;
    for (unsigned k = 0; k < 3; ++k) cube.min[k] = std::int32_t{key[k]} + VoxelGrid::kMinVoxel;
    cube.size = std::int32_t{1} << (tree->getTreeDepth() - leaf.getDepth());
    (tree->isNodeOccupied(*leaf) ? occupied : free).insert(cube);
  }
  return VoxelMap::build(before.resolution_m(), std::move(occupied), std::move(free),
                         before.unknown(), before.limits(), before.sensor(), std::move(tree));
}

}  // namespace camway::scene
