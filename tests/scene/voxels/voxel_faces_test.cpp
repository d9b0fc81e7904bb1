// SPDX-License-Identifier: MIT
#include "daemon/scene/voxels/voxel_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "tests/scene/voxels/voxel_sample.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kFacesSeed = 77101;

/// Returns six times the enclosed volume, in units of a voxel.
long double volume_sixfold(const Mesh& mesh) {
  long double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const geometry::Triangle t = mesh.triangle(i);
    sum += static_cast<long double>(t[0].dot(t[1].cross(t[2])));
  }
  return sum;
}

TEST(SkinOf, IsClosedAndHasTheFacesThatNoNeighbourCovers) {
  testing::Random random(kFacesSeed + 2);
  for (int trial = 0; trial < 100; ++trial) {
    const VoxelSample sample(random);
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
    const std::optional<Mesh> built = faces_of(sample.set, 1.0, 2 * faces);
    ASSERT_TRUE(built);
    ASSERT_EQ(built->triangles.size(), 2 * faces);
    std::map<std::array<std::uint32_t, 2>, int> edges;
    for (const auto& t : built->triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        ++edges[{t[k], t[(k + 1) % 3]}];
        --edges[{t[(k + 1) % 3], t[k]}];
      }
    }
    for (const auto& [edge, surplus] : edges) ASSERT_EQ(surplus, 0);
    // Coordinates are integers below 2^20, so doubles hold the products of a local test.
    if (std::abs(built->bounds().sizes().maxCoeff()) < 1000.0) {
      EXPECT_EQ(volume_sixfold(*built), 6.0L * static_cast<long double>(sample.reference.size()));
    }
    if (faces > 0) {
      EXPECT_FALSE(faces_of(sample.set, 1.0, 2 * faces - 1));
    }
  }
}

TEST(SkinOf, DependsOnTheSetOnly) {
  testing::Random random(kFacesSeed + 3);
  for (int trial = 0; trial < 20; ++trial) {
    const VoxelSample sample(random);
    VoxelSet other;
    for (auto voxel = sample.reference.rbegin(); voxel != sample.reference.rend(); ++voxel) {
      other.insert(*voxel);
    }
    const std::optional<Mesh> a = faces_of(sample.set, 0.1, 1'000'000);
    const std::optional<Mesh> b = faces_of(other, 0.1, 1'000'000);
    EXPECT_EQ(a->vertices, b->vertices);
    EXPECT_EQ(a->triangles, b->triangles);
  }
}

using Corners = std::vector<std::array<double, 9>>;

Corners sorted_triangles(const Mesh& mesh) {
  Corners triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<double, 9>& corners = triangles.emplace_back();
    std::size_t at = 0;
    for (const geometry::Vec3& corner : mesh.triangle(i)) {
      for (const double coordinate : corner) corners[at++] = coordinate;
    }
  }
  std::ranges::sort(triangles);
  return triangles;
}

TEST(VoxelFaces, HasTheFacesOfTheWholeByBricks) {
  testing::Random random(kFacesSeed + 5);
  for (int trial = 0; trial < 100; ++trial) {
    const VoxelSample sample(random);
    const Mesh whole = *faces_of(sample.set, 0.1, 1'000'000);
    const std::optional<VoxelFaces> built = VoxelFaces::of(sample.set, 0.1, whole.triangles.size());
    ASSERT_TRUE(built);
    ASSERT_EQ(sorted_triangles(joined(built->parts())), sorted_triangles(whole));
    for (std::size_t i = 0; i < built->parts().size(); ++i) {
      const MeshPart& part = built->parts()[i];
      ASSERT_FALSE(part.mesh->triangles.empty());
      ASSERT_TRUE(i == 0 || built->parts()[i - 1].key < part.key);
      ASSERT_LE(part.bounds.sizes().maxCoeff(), 16 * 0.1 + 1e-9);
      ASSERT_TRUE(part.bounds.isApprox(part.mesh->bounds(), 0.0));
    }
    if (!whole.triangles.empty()) {
      EXPECT_FALSE(VoxelFaces::of(sample.set, 0.1, whole.triangles.size() - 1));
    }
  }
}

/// After any changes the faces equal those made from scratch, and share all equal bricks with those
/// before.
TEST(VoxelFaces, UpdatedIsMadeAnewAndSharesWhatIsEqual) {
  testing::Random random(kFacesSeed + 6);
  int shared = 0;
  int others = 0;
  for (int trial = 0; trial < 30; ++trial) {
    VoxelSet set = VoxelSample(random).set;
    VoxelFaces built = *VoxelFaces::of(set, 0.1, 1'000'000);
    for (int step = 0; step < 10; ++step) {
      VoxelSet next = set;
      for (int i = static_cast<int>(random() % 4); i >= 0; --i) {
        const auto near = [&] { return static_cast<std::int32_t>(random() % 48) - 24; };
        const std::uint64_t key = BlockKey::of({near(), near(), near()});
        VoxelSet::Bits bits = next.block(key);
        bits[random() % 8] ^= std::uint64_t{1} << random() % 64;
        next.set_block(key, bits);
      }
      const VoxelFaces anew = *VoxelFaces::of(next, 0.1, 1'000'000);
      const std::size_t triangles = joined(anew.parts()).triangles.size();
      const std::optional<VoxelFaces> updated = built.updated(set, next, 0.1, triangles);
      ASSERT_TRUE(updated);
      if (triangles > 0) {
        ASSERT_FALSE(built.updated(set, next, 0.1, triangles - 1));
      }
      ASSERT_EQ(updated->parts().size(), anew.parts().size());
      for (std::size_t i = 0; i < anew.parts().size(); ++i) {
        const MeshPart& part = updated->parts()[i];
        ASSERT_EQ(part.key, anew.parts()[i].key);
        ASSERT_EQ(part.mesh->vertices, anew.parts()[i].mesh->vertices);
        ASSERT_EQ(part.mesh->triangles, anew.parts()[i].mesh->triangles);
        const auto old = std::ranges::find(built.parts(), part.key, &MeshPart::key);
        const bool is_equal = old != built.parts().end() &&
                              old->mesh->vertices == part.mesh->vertices &&
                              old->mesh->triangles == part.mesh->triangles;
        ASSERT_EQ(is_equal, old != built.parts().end() && old->mesh == part.mesh);
        (is_equal ? shared : others) += 1;
      }
      set = std::move(next);
      built = *updated;
    }
  }
  EXPECT_GT(shared, 500);
  EXPECT_GT(others, 100);
}

}  // namespace
}  // namespace camway::scene
