// SPDX-License-Identifier: MIT
#include "daemon/scene/mirror/voxel_tree.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <random>
#include <set>

#include "tests/support/random.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kTreeSeed = 77103;

using Cubes = std::vector<std::array<std::int32_t, 4>>;  ///< lowest voxel and size, sorted

/// Returns voxels and complete cubes about a place: the origin, where all octants of the root meet,
/// or another place, up to the ends of the keys.
VoxelSet random_voxels(testing::Random& random) {
  VoxelSet set;
  const auto pick = [&](std::int32_t low, std::int32_t high) {
    return std::uniform_int_distribution<std::int32_t>(low, high)(random);
  };
  Voxel middle{};
  for (std::int32_t& at : middle) {
    at = std::array{0, 8, 1000, VoxelGrid::kMaxVoxel - 40, VoxelGrid::kMinVoxel + 40}[random() % 5];
  }
  const auto beside = [&](std::int32_t at, std::int32_t reach) { return at + pick(-reach, reach); };
  for (int i = pick(0, 150); i > 0; --i) {
    set.insert(Voxel{beside(middle[0], 12), beside(middle[1], 12), beside(middle[2], 40)});
  }
  for (int i = pick(0, 3); i > 0; --i) {
    const std::int32_t size = 1 << pick(0, 4);
    VoxelCube cube{middle, size};
    for (std::int32_t& at : cube.min) at = beside(at, 16) & ~(size - 1);
    set.insert(cube);
  }
  return set;
}

Cubes cubes_of(const VoxelTree& tree) {
  Cubes cubes;
  tree.for_each_cube([&](const VoxelCube& cube) {
    cubes.push_back({cube.min[0], cube.min[1], cube.min[2], cube.size});
  });
  std::ranges::sort(cubes);
  return cubes;
}

/// Returns the cubes to which OctoMap prunes the same voxels.
Cubes octomaps_cubes(const VoxelSet& set) {
  octomap::OcTree tree(1.0);
  const auto key = [](std::int32_t voxel) {
    return static_cast<octomap::key_type>(voxel - VoxelGrid::kMinVoxel);
  };
  set.for_each([&](const Voxel& voxel) {
    const octomap::OcTreeKey at(key(voxel[0]), key(voxel[1]), key(voxel[2]));
    tree.setNodeValue(at, tree.getClampingThresMaxLog(), true);
  });
  tree.updateInnerOccupancy();
  tree.prune();
  Cubes cubes;
  if (tree.getRoot() == nullptr) return cubes;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const octomap::OcTreeKey low = leaf.getIndexKey();
    cubes.push_back({low[0] + VoxelGrid::kMinVoxel, low[1] + VoxelGrid::kMinVoxel,
                     low[2] + VoxelGrid::kMinVoxel, 1 << (16 - leaf.getDepth())});
  }
  std::ranges::sort(cubes);
  return cubes;
}

TEST(VoxelTree, ConsistsOfOctoMapsCubes) {
  testing::Random random(kTreeSeed);
  int large = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const VoxelSet set = random_voxels(random);
    const VoxelTree tree(set);
    const Cubes cubes = cubes_of(tree);
    ASSERT_EQ(cubes, octomaps_cubes(set)) << "trial " << trial;
    ASSERT_GE(tree.node_count(), cubes.size());
    large +=
        static_cast<int>(std::ranges::count_if(cubes, [](const auto& c) { return c[3] >= 8; }));
  }
  EXPECT_GT(large, 30) << "whole blocks were among them";
}

TEST(VoxelTree, ContainsItsVoxelsAndNoOthers) {
  testing::Random random(kTreeSeed + 1);
  for (int trial = 0; trial < 300; ++trial) {
    const VoxelSet set = random_voxels(random);
    const VoxelTree tree(set);
    set.for_each([&](const Voxel& voxel) {
      ASSERT_TRUE(tree.contains(voxel));
      Voxel beside = voxel;
      beside[random() % 3] += static_cast<std::int32_t>(random() % 65) - 32;
      ASSERT_EQ(tree.contains(beside), set.contains(beside));
    });
    for (int i = 0; i < 100; ++i) {
      Voxel anywhere{};
      for (std::int32_t& at : anywhere) at = static_cast<std::int32_t>(random() % 65536) - 32768;
      ASSERT_EQ(tree.contains(anywhere), set.contains(anywhere));
    }
  }
}

/// Full cubes come and go, so that branches fill up, vanish and appear.
TEST(VoxelTree, UpdatedIsTheTreeThatIsMadeAnew) {
  testing::Random random(kTreeSeed + 2);
  for (int trial = 0; trial < 60; ++trial) {
    VoxelSet set = random_voxels(random);
    VoxelTree tree(set);
    for (int step = 0; step < 6; ++step) {
      VoxelSet next = set;
      random_voxels(random).for_each([&](const Voxel& voxel) { next.insert(voxel); });
      const auto low = [&] { return (static_cast<std::int32_t>(random() % 5) - 2) * 64; };
      const VoxelCube cube{{low(), low(), low()}, 64};
      if (random() % 2 == 0) {
        next.insert(cube);
      } else {
        for (unsigned place = 0; place < 512; ++place) {
          next.set_block(BlockKey::in_cube(BlockKey::of(cube.min), place), {});
        }
      }
      const VoxelTree updated = tree.updated(set, next);
      const VoxelTree anew(next);
      ASSERT_EQ(cubes_of(updated), cubes_of(anew));
      ASSERT_EQ(updated.node_count(), anew.node_count());
      ASSERT_EQ(updated.memory_bytes(), anew.memory_bytes());
      ASSERT_EQ(updated.voxels(), next.size());
      const VoxelSet::Range bounds = next.bounds();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(updated.bounds()[axis].first, bounds[axis].first);
        ASSERT_EQ(updated.bounds()[axis].last, bounds[axis].last);
      }
      set = next;
      tree = updated;
    }
  }
}

TEST(VoxelTree, AStopLeavesVoxelsOut) {
  std::stop_source stop;
  stop.request_stop();
  VoxelSet voxels;
  voxels.insert(VoxelCube{{0, 0, 0}, 64});
  EXPECT_EQ(VoxelTree(voxels, stop.get_token()).voxels(), 0U);
  EXPECT_EQ(VoxelTree(VoxelSet()).updated({}, voxels, stop.get_token()).voxels(), 0U);
}

TEST(VoxelTree, OfNothingHoldsNothing) {
  VoxelSet looked_at;
  EXPECT_FALSE(VoxelMarker(looked_at).contains({1, 2, 3})) << "leaves a block without voxels";
  for (const VoxelSet& set : {VoxelSet(), looked_at}) {
    const VoxelTree tree(set);
    EXPECT_FALSE(tree.contains({0, 0, 0}));
    EXPECT_FALSE(tree.contains({1, 2, 3}));
    EXPECT_TRUE(cubes_of(tree).empty());
  }
}

}  // namespace
}  // namespace camway::scene
