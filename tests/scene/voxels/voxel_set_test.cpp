// SPDX-License-Identifier: MIT
#include "daemon/scene/voxels/voxel_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "tests/scene/voxels/voxel_sample.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kSetSeed = 77101;

TEST(VoxelSet, HoldsWhatWasPutIn) {
  testing::Random random(kSetSeed);
  for (int trial = 0; trial < 200; ++trial) {
    const VoxelSample sample(random);
    ASSERT_EQ(voxels_of(sample.set), sample.reference);
    ASSERT_EQ(sample.set.size(), sample.reference.size());
    ASSERT_EQ(sample.set.empty(), sample.reference.empty());
    for (const Voxel& voxel : sample.reference) {
      Voxel beside = voxel;
      beside[random() % 3] += random() % 2 == 0 ? 1 : -1;
      ASSERT_TRUE(sample.set.contains(voxel));
      ASSERT_EQ(sample.set.contains(beside), sample.reference.contains(beside));
    }
  }
  EXPECT_FALSE(VoxelSet().contains({VoxelSet::kMostVoxels, 0, 0}));
  EXPECT_FALSE(VoxelSet().contains({0, -VoxelSet::kMostVoxels - 1, 0}));
}

/// Returns the voxels of `range` that are not in `set`, block by block.
VoxelSet complement_in(const VoxelSet::Range& range, const VoxelSet& set) {
  VoxelSet result;
  for (std::int32_t x = range[0].first & ~7; x <= range[0].last; x += 8) {
    for (std::int32_t y = range[1].first & ~7; y <= range[1].last; y += 8) {
      for (std::int32_t z = range[2].first & ~7; z <= range[2].last; z += 8) {
        const std::uint64_t key = BlockKey::of({x, y, z});
        VoxelSet::Bits bits = VoxelSet::bits_in(range, key);
        for (std::size_t k = 0; k < bits.size(); ++k) bits[k] &= ~set.block(key)[k];
        result.set_block(key, bits);
      }
    }
  }
  return result;
}

TEST(VoxelSet, TheComplementInARangeIsWhatIsMissingThere) {
  testing::Random random(kSetSeed + 1);
  for (int trial = 0; trial < 100; ++trial) {
    const VoxelSample sample(random);
    VoxelSet::Range range;
    for (VoxelRange& along : range) {
      along.first = static_cast<std::int32_t>(random() % 40) - 20;
      along.last = along.first + static_cast<std::int32_t>(random() % 20);
    }
    VoxelReference expected;
    Voxel voxel{};
    for (voxel[0] = range[0].first; voxel[0] <= range[0].last; ++voxel[0]) {
      for (voxel[1] = range[1].first; voxel[1] <= range[1].last; ++voxel[1]) {
        for (voxel[2] = range[2].first; voxel[2] <= range[2].last; ++voxel[2]) {
          if (!sample.reference.contains(voxel)) expected.insert(voxel);
        }
      }
    }
    const VoxelSet complement = complement_in(range, sample.set);
    ASSERT_EQ(voxels_of(complement), expected);
    ASSERT_EQ(complement.size(), expected.size());
    if (expected.empty()) continue;
    const VoxelSet::Range bounds = complement.bounds();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto less = [axis](const Voxel& a, const Voxel& b) { return a[axis] < b[axis]; };
      EXPECT_EQ(bounds[axis].first, (*std::ranges::min_element(expected, less))[axis]);
      EXPECT_EQ(bounds[axis].last, (*std::ranges::max_element(expected, less))[axis]);
    }
  }
}

/// Copies that are changed separately are compared with sets that share nothing.
TEST(VoxelSet, CopiesGoTheirOwnWays) {
  testing::Random random(kSetSeed + 4);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<VoxelSample> samples{VoxelSample(random)};
    for (int step = 0; step < 8; ++step) {
      VoxelSample sample = samples[random() % samples.size()];
      for (int i = 0; i < 20; ++i) {
        const auto near = [&] { return static_cast<std::int32_t>(random() % 200) - 100; };
        const Voxel voxel{near(), near(), near()};
        if (random() % 2 == 0) {
          ASSERT_EQ(sample.set.insert(voxel), sample.reference.insert(voxel).second);
          continue;
        }
        const std::uint64_t key = BlockKey::of(voxel);
        sample.set.set_block(key, {});
        std::erase_if(sample.reference, [&](const Voxel& v) { return BlockKey::of(v) == key; });
      }
      samples.push_back(std::move(sample));
    }
    for (const VoxelSample& a : samples) {
      ASSERT_EQ(voxels_of(a.set), a.reference);
      ASSERT_EQ(a.set.size(), a.reference.size());
      const VoxelSample& b = samples[random() % samples.size()];
      VoxelReference differing;
      a.set.for_each_difference(b.set, [&](std::uint64_t key, const auto& old, const auto& now) {
        ASSERT_NE(old, now);
        ASSERT_EQ(old, b.set.block(key));
        ASSERT_EQ(now, a.set.block(key));
        for (std::int32_t i = 0; i < 512; ++i) {
          const auto at = static_cast<std::size_t>(i / 64);
          if (((old[at] ^ now[at]) >> i % 64 & 1U) == 0) continue;
          const Voxel low = BlockKey::low_of(key);
          differing.insert({low[0] + i % 8, low[1] + i / 8 % 8, low[2] + i / 64});
        }
      });
      VoxelReference expected;
      std::ranges::set_symmetric_difference(a.reference, b.reference,
                                            std::inserter(expected, expected.end()));
      ASSERT_EQ(differing, expected);
    }
  }
}

}  // namespace
}  // namespace camway::scene
