// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/near_pairs.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>

#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using geometry::Quat;
using geometry::Vec3;
using testing_search::SearchScene;
using testing_search::sphere;

constexpr double kPairRounding_m = 1e-12;

motion::Pose moved(const motion::Pose& pose, const Vec3& by_W) {
  return {pose.position + by_W, pose.orientation};
}

/// A free pose in the cube of the scene; nothing if there is none among a few.
std::optional<motion::Pose> free_pose(testing::Random& random, const SearchScene& scene) {
  for (int i = 0; i < 20; ++i) {
    const motion::Pose pose{random.in_cube(1.0), random.rotation()};
    if (scene.distance_m(pose) > 1e-3) return pose;
  }
  return std::nullopt;
}

// The oracle computes the distances of all pairs of triangles.
TEST(NearPairs, BeginWithTheGapOfTheBody) {
  testing::Random random(5101);
  int near = 0;
  for (int run = 0; run < 60; ++run) {
    SCOPED_TRACE(run);
    const SearchScene scene(testing::scattered_triangles(random, 40, 0.6));
    const std::optional<motion::Pose> pose = free_pose(random, scene);
    if (!pose) continue;
    FreeSpace space = scene.space();
    const double gap_m = scene.distance_m(*pose);
    const double horizon_m = random.uniform(0.5, 3.0) * gap_m;
    const std::vector<NearPair> pairs = near_pairs(space, *pose, horizon_m);
    EXPECT_EQ(pairs.empty(), gap_m >= horizon_m);
    if (pairs.empty()) continue;
    ++near;
    EXPECT_NEAR(pairs.front().gap_m, gap_m, kPairRounding_m);
    EXPECT_TRUE(std::ranges::is_sorted(pairs, {}, &NearPair::gap_m));
    for (const NearPair& pair : pairs) {
      EXPECT_LT(pair.gap_m, horizon_m);
      EXPECT_NEAR(pair.away_W.norm(), 1.0, kPairRounding_m);
    }
  }
  EXPECT_GT(near, 30);
}

// The boxes of all its triangles overlap those of the body, however near the horizon is.
TEST(NearPairs, EndBesideASlantedPlaneOfManyTriangles) {
  const Quat tilt(Eigen::AngleAxisd(0.7, Vec3(1, 1, 0).normalized()));
  for (const std::uint32_t side : {60U, 200U}) {
    SCOPED_TRACE(side);
    scene::Mesh mesh;
    for (std::uint32_t i = 0; i <= side; ++i) {
      for (std::uint32_t k = 0; k <= side; ++k) {
        mesh.vertices.push_back(tilt * Vec3(2.0 * i / side - 1.0, 2.0 * k / side - 1.0, 0.0));
      }
    }
    for (std::uint32_t i = 0; i < side; ++i) {
      for (std::uint32_t k = 0; k < side; ++k) {
        const std::uint32_t a = i * (side + 1) + k;
        mesh.triangles.push_back({a, a + side + 1, a + 1});
        mesh.triangles.push_back({a + 1, a + side + 1, a + side + 2});
      }
    }
    const SearchScene scene(mesh,
                            *motion::Body::make(motion::BoxShape{Vec3::Zero(), Vec3(1, 1, 0.1)}));
    FreeSpace space = scene.space();
    const std::vector<NearPair> pairs = near_pairs(space, {tilt * Vec3(0, 0, 0.1), tilt}, 0.1);
    ASSERT_FALSE(pairs.empty());
    EXPECT_NEAR(pairs.front().gap_m, 0.05, kPairRounding_m);
  }
}

TEST(NearPairs, PointToWhereTheGapGrows) {
  testing::Random random(5102);
  constexpr double kStep_m = 1e-6;
  int checked = 0;
  for (int run = 0; run < 60; ++run) {
    SCOPED_TRACE(run);
    const SearchScene scene(testing::scattered_triangles(random, 10, 0.6));
    const std::optional<motion::Pose> pose = free_pose(random, scene);
    if (!pose) continue;
    FreeSpace space = scene.space();
    const std::vector<NearPair> pairs = near_pairs(space, *pose, 2.0);
    if (pairs.empty()) continue;
    const Vec3 step_W = kStep_m * random.in_cube(1.0).normalized();
    const double grown_m = scene.distance_m(moved(*pose, step_W)) - scene.distance_m(*pose);
    // Other pairs may be as near, but none of them is promised more.
    double promised_m = std::numeric_limits<double>::infinity();
    for (const NearPair& pair : pairs) {
      promised_m = std::min(promised_m, pair.gap_m - pairs.front().gap_m + pair.away_W.dot(step_W));
    }
    EXPECT_NEAR(grown_m, promised_m, 1e-3 * kStep_m);
    ++checked;
  }
  EXPECT_GT(checked, 30);
}

// All of a plate of 28,800 triangles is within the horizon: a smaller one shows enough.
TEST(NearPairs, OfALargeBodyAreTheNearestOnes) {
  constexpr std::uint32_t kSteps = 120;
  constexpr double kGap_m = 0.1;
  motion::MeshShape plate;
  for (std::uint32_t i = 0; i <= kSteps; ++i) {
    for (std::uint32_t k = 0; k <= kSteps; ++k) {
      plate.vertices_C.emplace_back(i / double{kSteps}, k / double{kSteps}, 0.0);
    }
  }
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    for (std::uint32_t k = 0; k < kSteps; ++k) {
      const std::uint32_t at = i * (kSteps + 1) + k;
      plate.triangles.push_back({at, at + kSteps + 1, at + 1});
      plate.triangles.push_back({at + 1, at + kSteps + 1, at + kSteps + 2});
    }
  }
  scene::Mesh floor;
  testing::add_cuboid(floor, {-2, -2, -1}, {2, 2, 0});
  const SearchScene scene(floor, *motion::Body::make(plate));
  FreeSpace space = scene.space();
  // A slope puts one corner nearest.
  const motion::Pose pose{Vec3(0, 0, kGap_m),
                          Quat(Eigen::AngleAxisd(-0.05, Vec3(1, -1, 0).normalized()))};
  const std::vector<NearPair> pairs = near_pairs(space, pose, 2.0);
  ASSERT_FALSE(pairs.empty());
  EXPECT_LE(pairs.size(), kMostPairs);
  EXPECT_NEAR(pairs.front().gap_m, space.gap_m(pose, 2.0), kPairRounding_m);
}

TEST(NearPairs, KeepTheRequiredClearanceAndTheBall) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-1, -1, -1}, {1, 1, 0});
  SearchScene scene(mesh, sphere(0.2));
  scene.detect.clearance_m = 0.05;
  FreeSpace space = scene.space();
  const std::vector<NearPair> pairs =
      near_pairs(space, {Vec3(0.1, 0.2, 0.5), Quat::Identity()}, 1.0);
  ASSERT_FALSE(pairs.empty());
  EXPECT_NEAR(pairs.front().gap_m, 0.25, kPairRounding_m);
  EXPECT_TRUE(pairs.front().away_W.isApprox(Vec3::UnitZ()));
}

}  // namespace
}  // namespace camway::correction
