// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <set>

#include "daemon/scene/voxels/voxel_set.h"
#include "tests/support/random.h"

namespace camway::scene {

using VoxelReference = std::set<Voxel>;

/// Random voxels near a corner where blocks of all signs meet, or anywhere; some form cubes.
struct VoxelSample {
  VoxelSet set;
  VoxelReference reference;

  explicit VoxelSample(testing::Random& random) {
    const std::int32_t far = static_cast<std::int32_t>(random() % 3) * (VoxelSet::kMostVoxels - 40);
    const auto near = [&](int reach) {
      return static_cast<std::int32_t>(random() % static_cast<unsigned>(2 * reach)) - reach;
    };
    for (int i = static_cast<int>(random() % 200); i-- > 0;) {
      const Voxel voxel{far / 2 + near(12), near(12), -far / 2 + near(12)};
      EXPECT_EQ(set.insert(voxel), reference.insert(voxel).second);
    }
    for (int i = static_cast<int>(random() % 4); i-- > 0;) {
      const std::int32_t size = 1 << random() % 5;
      const VoxelCube cube{{near(4) * size, near(4) * size, near(4) * size}, size};
      set.insert(cube);
      for (std::int32_t k = 0; k < size * size * size; ++k) {
        reference.insert(
            {cube.min[0] + k % size, cube.min[1] + k / size % size, cube.min[2] + k / size / size});
      }
    }
  }
};

inline VoxelReference voxels_of(const VoxelSet& set) {
  VoxelReference voxels;
  set.for_each([&](const Voxel& voxel) { EXPECT_TRUE(voxels.insert(voxel).second); });
  return voxels;
}

}  // namespace camway::scene
