// SPDX-License-Identifier: MIT
#include "daemon/scene/voxel_set.h"

#include <gtest/gtest.h>

#include <iostream>
#include <map>
#include <random>
#include <set>

namespace camway::scene {
namespace {

constexpr std::uint64_t kSeed = 77101;

using Reference = std::set<Voxel>;

/// Voxels near a corner where blocks of all signs meet, or anywhere, some as cubes.
struct Sample {
  VoxelSet set;
  Reference reference;

  explicit Sample(std::mt19937_64& random) {
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

Reference voxels_of(const VoxelSet& set) {
  Reference voxels;
  set.for_each([&](const Voxel& voxel) { EXPECT_TRUE(voxels.insert(voxel).second); });
  return voxels;
}

TEST(VoxelSet, HoldsWhatWasPutIn) {
  std::cout << "seed " << kSeed << '\n';
  std::mt19937_64 random(kSeed);
  for (int trial = 0; trial < 200; ++trial) {
    const Sample sample(random);
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

TEST(VoxelSet, TheComplementInARangeIsWhatIsMissingThere) {
  std::mt19937_64 random(kSeed + 1);
  for (int trial = 0; trial < 100; ++trial) {
    const Sample sample(random);
    VoxelSet::Range range;
    for (VoxelRange& along : range) {
      along.first = static_cast<std::int32_t>(random() % 40) - 20;
      along.last = along.first + static_cast<std::int32_t>(random() % 20);
    }
    Reference expected;
    Voxel voxel{};
    for (voxel[0] = range[0].first; voxel[0] <= range[0].last; ++voxel[0]) {
      for (voxel[1] = range[1].first; voxel[1] <= range[1].last; ++voxel[1]) {
        for (voxel[2] = range[2].first; voxel[2] <= range[2].last; ++voxel[2]) {
          if (!sample.reference.contains(voxel)) expected.insert(voxel);
        }
      }
    }
    const VoxelSet complement = sample.set.complement_in(range);
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

/// Six times the volume inside, in units of a voxel.
long double volume_sixfold(const Mesh& mesh) {
  long double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const geometry::Triangle t = mesh.triangle(i);
    sum += static_cast<long double>(t[0].dot(t[1].cross(t[2])));
  }
  return sum;
}

TEST(SkinOf, IsClosedAndHasTheFacesThatNoNeighbourCovers) {
  std::cout << "seed " << kSeed << '\n';
  std::mt19937_64 random(kSeed + 2);
  for (int trial = 0; trial < 100; ++trial) {
    const Sample sample(random);
    std::size_t faces = 0;
    for (const Voxel& voxel : sample.reference) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int side : {-1, 1}) {
          Voxel beside = voxel;
          beside[axis] += side;
          faces += sample.reference.contains(beside) ? 0U : 1U;
        }
      }
    }
    const std::optional<Mesh> skin = skin_of(sample.set, 1.0, 2 * faces);
    ASSERT_TRUE(skin);
    ASSERT_EQ(skin->triangles.size(), 2 * faces);
    std::map<std::array<std::uint32_t, 2>, int> edges;
    for (const auto& t : skin->triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        ++edges[{t[k], t[(k + 1) % 3]}];
        --edges[{t[(k + 1) % 3], t[k]}];
      }
    }
    for (const auto& [edge, surplus] : edges) ASSERT_EQ(surplus, 0);
    // Coordinates are whole numbers below 2^20, so doubles hold the products of a test nearby.
    if (std::abs(skin->bounds().sizes().maxCoeff()) < 1000.0) {
      EXPECT_EQ(volume_sixfold(*skin), 6.0L * static_cast<long double>(sample.reference.size()));
    }
    if (faces > 0) {
      EXPECT_FALSE(skin_of(sample.set, 1.0, 2 * faces - 1));
    }
  }
}

TEST(SkinOf, DependsOnTheSetOnly) {
  std::mt19937_64 random(kSeed + 3);
  for (int trial = 0; trial < 20; ++trial) {
    const Sample sample(random);
    VoxelSet other;
    for (auto voxel = sample.reference.rbegin(); voxel != sample.reference.rend(); ++voxel) {
      other.insert(*voxel);
    }
    const std::optional<Mesh> a = skin_of(sample.set, 0.1, 1'000'000);
    const std::optional<Mesh> b = skin_of(other, 0.1, 1'000'000);
    EXPECT_EQ(a->vertices, b->vertices);
    EXPECT_EQ(a->triangles, b->triangles);
  }
}

}  // namespace
}  // namespace camway::scene
