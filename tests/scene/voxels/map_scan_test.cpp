// SPDX-License-Identifier: MIT
#include "daemon/scene/voxels/map_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <limits>
#include <random>
#include <vector>

#include "tests/support/random.h"

namespace camway::scene {
namespace {

using geometry::Vec3;
using ::testing::HasSubstr;

constexpr std::uint64_t kScanSeed = 77301;
constexpr double kVoxel_m = 0.1;

std::shared_ptr<const VoxelMap> empty_map(const SensorModel& sensor) {
  return VoxelMap::build(kVoxel_m, {}, {}, UnknownSpace::kFree, {}, sensor).map;
}

/// Returns the scan of a sensor in a room of 4 m, with rays without a return.
std::vector<Vec3> sight(testing::Random& random, const Vec3& origin) {
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    double way_m = 30.0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double wall_m = direction[k] > 0.0 ? 2.03 : -2.03;
      if (i % 7 != 0) way_m = std::min(way_m, (wall_m - origin[k]) / direction[k]);
    }
    points.push_back(origin + way_m * direction);
  }
  return points;
}

/// The oracle for a series of scans is OctoMap itself, with one tree that is never copied.
TEST(Scanned, IsWhatOctoMapMakesOfTheSameScans) {
  testing::Random random(kScanSeed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const double max_range_m : {std::numeric_limits<double>::infinity(), 3.0}) {
    SensorModel sensor;
    sensor.hit_probability = 0.8;
    sensor.miss_probability = 0.3;
    sensor.least_probability = 0.05;
    sensor.most_probability = 0.9;
    sensor.max_range_m = max_range_m;
    octomap::OcTree tree(kVoxel_m);
    tree.setProbHit(sensor.hit_probability);
    tree.setProbMiss(sensor.miss_probability);
    tree.setClampingThresMin(sensor.least_probability);
    tree.setClampingThresMax(sensor.most_probability);
    std::shared_ptr<const VoxelMap> map = empty_map(sensor);
    for (int scan = 0; scan < 8; ++scan) {
      const Vec3 origin(unit(random), unit(random), unit(random));
      const std::vector<Vec3> points = sight(random, origin);
      octomap::Pointcloud cloud;
      const auto single = [](const Vec3& p) {
        return octomap::point3d(static_cast<float>(p.x()), static_cast<float>(p.y()),
                                static_cast<float>(p.z()));
      };
      for (const Vec3& point : points) cloud.push_back(single(point));
      tree.insertPointCloud(cloud, single(origin), max_range_m > 1e9 ? -1.0 : max_range_m);
      const VoxelMapResult next = scanned(*map, {origin, points});
      ASSERT_TRUE(next.map) << next.error;
      EXPECT_FALSE(map->occupied().size() == next.map->occupied().size() &&
                   map->free().size() == next.map->free().size());
      map = next.map;
      std::uint64_t occupied = 0;
      std::uint64_t free = 0;
      tree.expand();
      for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
        const octomap::OcTreeKey key = leaf.getKey();
        const Voxel voxel{key[0] - 32768, key[1] - 32768, key[2] - 32768};
        const bool is_occupied = tree.isNodeOccupied(*leaf);
        (is_occupied ? occupied : free) += 1;
        ASSERT_EQ(map->occupied().contains(voxel), is_occupied);
        ASSERT_EQ(map->free().contains(voxel), !is_occupied);
        const Beliefs* const beliefs = map->beliefs(BlockKey::of(voxel));
        ASSERT_TRUE(beliefs);
        const auto place =
            static_cast<std::size_t>((voxel[0] & 7) + (voxel[1] & 7) * 8 + (voxel[2] & 7) * 64);
        ASSERT_EQ((*beliefs)[place], leaf->getLogOdds()) << "bit for bit";
      }
      ASSERT_EQ(map->occupied().size(), occupied);
      ASSERT_EQ(map->free().size(), free);
    }
    EXPECT_GT(map->occupied().size(), 200U);
    EXPECT_GT(map->free().size(), 5000U);
  }
}

TEST(Scanned, BeginsWithTheCertaintyOfAMapThatWasRead) {
  VoxelSet occupied;
  VoxelSet free;
  occupied.insert(Voxel{5, 0, 0});
  free.insert(Voxel{0, 5, 0});
  const auto before = VoxelMap::build(kVoxel_m, occupied, free, UnknownSpace::kFree).map;
  const std::vector<Vec3> beyond = {Vec3(1.05, 0.05, 0.05)};
  std::shared_ptr<const VoxelMap> map = before;
  int scans = 0;
  for (; map->occupied().contains({5, 0, 0}) && scans < 100; ++scans) {
    map = scanned(*map, {Vec3(0.05, 0.05, 0.05), beyond}).map;
  }
  EXPECT_GT(scans, 3) << "one look does not take back what was sure";
  EXPECT_LT(scans, 20);
  EXPECT_TRUE(map->free().contains({0, 5, 0}));
  EXPECT_TRUE(map->occupied().contains({10, 0, 0}));
  EXPECT_TRUE(before->occupied().contains({5, 0, 0})) << "a map never changes";
}

/// The same, but map and tree begin with a file whose content counts as certain.
TEST(Scanned, GoesOnFromWhatWasReadAsOctoMapDoes) {
  testing::Random random(kScanSeed + 1);
  octomap::OcTree tree(kVoxel_m);
  VoxelSet occupied;
  VoxelSet free;
  for (int i = 0; i < 4000; ++i) {
    Voxel voxel{};
    for (std::int32_t& at : voxel) at = static_cast<std::int32_t>(random() % 44) - 22;
    if (occupied.contains(voxel) || free.contains(voxel)) continue;
    const bool is_occupied = random() % 4 == 0;
    (is_occupied ? occupied : free).insert(voxel);
    const auto key = [](std::int32_t v) { return static_cast<octomap::key_type>(v + 32768); };
    tree.setNodeValue(octomap::OcTreeKey(key(voxel[0]), key(voxel[1]), key(voxel[2])),
                      is_occupied ? tree.getClampingThresMaxLog() : tree.getClampingThresMinLog(),
                      true);
  }
  tree.updateInnerOccupancy();
  std::shared_ptr<const VoxelMap> map =
      VoxelMap::build(kVoxel_m, occupied, free, UnknownSpace::kFree).map;
  for (int scan = 0; scan < 10; ++scan) {
    const Vec3 origin(0.4, -0.3, 0.2);
    const std::vector<Vec3> points = sight(random, origin);
    octomap::Pointcloud cloud;
    for (const Vec3& p : points) {
      cloud.push_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                      static_cast<float>(p.z()));
    }
    tree.insertPointCloud(cloud, octomap::point3d(0.4F, -0.3F, 0.2F));
    map = scanned(*map, {origin, points}).map;
    tree.expand();
    std::uint64_t leaves = 0;
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf, ++leaves) {
      const octomap::OcTreeKey key = leaf.getKey();
      const Voxel voxel{key[0] - 32768, key[1] - 32768, key[2] - 32768};
      ASSERT_EQ(map->occupied().contains(voxel), tree.isNodeOccupied(*leaf));
      ASSERT_EQ(map->free().contains(voxel), !tree.isNodeOccupied(*leaf));
    }
    ASSERT_EQ(map->occupied().size() + map->free().size(), leaves);
  }
}

TEST(Scanned, RefusesWhatOctoMapCannotHoldOrTakesTooLong) {
  const auto map = empty_map({});
  const auto error = [&](const Vec3& origin, const std::vector<Vec3>& points) {
    return scanned(*map, {origin, points}).error;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error({0, 0, 0}, {}), "");
  EXPECT_THAT(error({nan, 0, 0}, {}), HasSubstr("origin"));
  EXPECT_THAT(error({0, 0, 0}, {Vec3(1, 0, 0), Vec3(0, nan, 0)}), HasSubstr("points_m[1]"));
  EXPECT_THAT(error({0, 0, 0}, {Vec3(0, 0, 3277)}), HasSubstr("points_m[0]"));
  EXPECT_THAT(error(Vec3::Constant(-3000), {Vec3::Constant(3000)}), HasSubstr("max_range_m"));
  EXPECT_THAT(error({0, 0, 0}, std::vector<Vec3>(5000, Vec3(3000, 0, 0))),
              HasSubstr("max_range_m"));
  SensorModel near;
  near.max_range_m = 1.0;
  EXPECT_TRUE(
      scanned(*empty_map(near), {Vec3::Zero(), std::vector<Vec3>(5000, Vec3(3000, 0, 0))}).map);
}

TEST(Scanned, TheChangedBlocksMakeTheNextMapOfTheOneBefore) {
  testing::Random random(kScanSeed + 2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::shared_ptr<const VoxelMap> map = empty_map({});
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (int scan = 0; scan < 6; ++scan) {
    const Vec3 origin(unit(random), unit(random), unit(random));
    std::vector<Vec3> points = sight(random, origin);
    if (scan > 2) points.resize(2);
    const std::shared_ptr<const VoxelMap> next = scanned(*map, {origin, points}).map;
    EXPECT_TRUE(next->blocks_changed_since(*next).empty());
    const std::vector<ScannedBlock> blocks = next->blocks_changed_since(*map);
    const std::shared_ptr<const VoxelMap> again = map->with(blocks).map;
    EXPECT_TRUE(again->blocks_changed_since(*next).empty());
    EXPECT_EQ(again->scanned_blocks(), next->scanned_blocks());
    for (std::size_t i = 1; i < blocks.size(); ++i) ASSERT_LT(blocks[i - 1].key, blocks[i].key);
    for (const ScannedBlock& block : blocks) {
      ASSERT_TRUE(block.beliefs);
      ASSERT_TRUE(block.occupied != map->occupied().block(block.key) ||
                  block.free != map->free().block(block.key) ||
                  map->beliefs(block.key) == nullptr || *map->beliefs(block.key) != *block.beliefs)
          << "it did not change";
      ASSERT_EQ(again->beliefs(block.key), next->beliefs(block.key)) << "it is shared";
    }
    fewest = std::min(fewest, blocks.size());
    map = next;
  }
  EXPECT_LT(10 * fewest, map->scanned_blocks());
}

TEST(SensorModel, NamesWhatCannotBe) {
  EXPECT_EQ(fault_in(SensorModel{}), "");
  const auto fault = [](auto change) {
    SensorModel sensor;
    change(sensor);
    return fault_in(sensor);
  };
  EXPECT_THAT(fault([](auto& s) { s.hit_probability = 0.5; }), HasSubstr("hit_probability"));
  EXPECT_THAT(fault([](auto& s) { s.miss_probability = 0.5; }), HasSubstr("miss_probability"));
  EXPECT_THAT(fault([](auto& s) { s.least_probability = 0.0; }), HasSubstr("least_probability"));
  EXPECT_THAT(fault([](auto& s) { s.most_probability = 1.0; }), HasSubstr("most_probability"));
  EXPECT_THAT(fault([](auto& s) { s.max_range_m = -1.0; }), HasSubstr("max_range_m"));
}

}  // namespace
}  // namespace camway::scene
