// SPDX-License-Identifier: MIT
#include "daemon/correction/search/free_pose.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file

constexpr double kSphere_m = 0.2;
constexpr double kPoseMargin_m = 0.01;
// The length of a move is the least in its direction to within the precision, and a direction is
// improved as long as that shortens it by half of that.
constexpr double kPrecise = 1.0 + 2.0 * kFreePosePrecision;
const PoseRule kAny = [](const motion::Pose&) { return true; };

motion::Pose pose_at(const Vec3& position) { return {position, Quat::Identity()}; }

void expect_free(const SearchScene& scene, const motion::Pose& from, const FreePose& found) {
  EXPECT_GE(scene.distance_m(found.pose), kPoseMargin_m);
  EXPECT_EQ(found.pose.orientation.coeffs(), from.orientation.coeffs());
  EXPECT_NEAR((found.pose.position - from.position).norm(), found.moved_m, 1e-12);
}

// A sphere that is `depth` into a wall has to move by that, and the margin.
TEST(NearestFreePose, OffAWallOfAnyTilt) {
  testing::Random random(1);
  std::uniform_real_distribution<double> share(0.05, 1.0);
  for (int run = 0; run < 100; ++run) {
    const Quat tilt = random.rotation();
    scene::Mesh mesh;
    testing::add_parallelogram(mesh, tilt * Vec3(-50, -50, 0), tilt * Vec3(100, 0, 0),
                               tilt * Vec3(0, 100, 0));
    const SearchScene scene(std::move(mesh), sphere(kSphere_m));
    FreeSpace space = scene.space();
    const double depth_m = share(random) * kSphere_m;
    const motion::Pose pose = pose_at(tilt * Vec3(0, 0, kSphere_m - depth_m));
    const std::optional<FreePose> found = nearest_free_pose(space, pose, kPoseMargin_m, kAny);
    ASSERT_TRUE(found);
    expect_free(scene, pose, *found);
    const double least_m = depth_m + kPoseMargin_m;
    EXPECT_GE(found->moved_m, least_m - 1e-12);
    EXPECT_LE(found->moved_m, kPrecise * least_m);
  }
}

// Out of a corner of two or three walls the way is the diagonal.
TEST(NearestFreePose, OutOfACorner) {
  for (const int walls : {1, 2, 3}) {
    scene::Mesh mesh;
    for (int axis = 0; axis < walls; ++axis) {
      const Vec3 u = Vec3::Unit((axis + 1) % 3);
      const Vec3 v = Vec3::Unit((axis + 2) % 3);
      testing::add_parallelogram(mesh, -50.0 * (u + v), 100.0 * u, 100.0 * v);
    }
    const SearchScene scene(std::move(mesh), sphere(kSphere_m));
    FreeSpace space = scene.space();
    for (const double gap : {0.1, 0.5, 0.9}) {
      const motion::Pose pose = pose_at(gap * kSphere_m * Vec3::Ones());
      const std::optional<FreePose> found = nearest_free_pose(space, pose, kPoseMargin_m, kAny);
      ASSERT_TRUE(found);
      expect_free(scene, pose, *found);
      const double least_m = std::sqrt(walls) * ((1.0 - gap) * kSphere_m + kPoseMargin_m);
      EXPECT_GE(found->moved_m, least_m - 1e-12);
      EXPECT_LE(found->moved_m, kPrecise * least_m);
    }
  }
}

// A sphere in a thin wall, most of it on one side: that one is nearer, however the wall is tilted.
TEST(NearestFreePose, StaysOnItsSideOfAWall) {
  testing::Random random(3);
  std::uniform_real_distribution<double> share(0.05, 0.9);
  for (int run = 0; run < 100; ++run) {
    const Quat tilt = random.rotation();
    scene::Mesh mesh;
    testing::add_parallelogram(mesh, tilt * Vec3(-50, -50, 0), tilt * Vec3(100, 0, 0),
                               tilt * Vec3(0, 100, 0));
    const SearchScene scene(std::move(mesh), sphere(kSphere_m));
    FreeSpace space = scene.space();
    const motion::Pose pose = pose_at(tilt * Vec3(0, 0, share(random) * kSphere_m));
    const std::optional<FreePose> found = nearest_free_pose(space, pose, kPoseMargin_m, kAny);
    ASSERT_TRUE(found);
    EXPECT_GT((tilt.inverse() * found->pose.position).z(), 0.0);
  }
}

// Half in a floor of which both sides are as near, and free: there is more room above it.
TEST(NearestFreePose, OfTwoAsNearTheOneWithMoreRoom) {
  for (const double up : {1.0, -1.0}) {
    scene::Mesh mesh;
    const double bottom_m = -up * 2.2 * kSphere_m;
    testing::add_cuboid(mesh, {-50, std::min(0.0, bottom_m), -50},
                        {50, std::max(0.0, bottom_m), 50});
    const SearchScene scene(std::move(mesh), sphere(kSphere_m));
    FreeSpace space = scene.space();
    const std::optional<FreePose> found =
        nearest_free_pose(space, pose_at(Vec3::Zero()), kPoseMargin_m, kAny);
    ASSERT_TRUE(found);
    EXPECT_GT(up * found->pose.position.y(), 0.0);
  }
}

TEST(NearestFreePose, WillDo) {
  scene::Mesh mesh;
  testing::add_parallelogram(mesh, {-50, -50, 0}, {100, 0, 0}, {0, 100, 0});
  const SearchScene scene(std::move(mesh), sphere(kSphere_m));
  FreeSpace space = scene.space();
  const motion::Pose pose = pose_at({0, 0, 0.5 * kSphere_m});
  const PoseRule is_beyond = [](const motion::Pose& p) { return p.position.z() < 0.0; };
  const std::optional<FreePose> found = nearest_free_pose(space, pose, kPoseMargin_m, is_beyond);
  ASSERT_TRUE(found);
  EXPECT_LT(found->pose.position.z(), 0.0);
  EXPECT_LE(found->moved_m, kPrecise * (1.5 * kSphere_m + kPoseMargin_m));
  EXPECT_FALSE(
      nearest_free_pose(space, pose, kPoseMargin_m, [](const motion::Pose&) { return false; }));
}

// The oracle: poses at random, none of which may be free and clearly nearer.
TEST(NearestFreePose, NothingNearerIsFree) {
  testing::Random random(4);
  const SearchScene scene(scattered_cuboids(random, 12, 0.6));
  FreeSpace space = scene.space();
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  std::normal_distribution<double> normal;
  int colliding = 0;
  int beaten = 0;
  for (int run = 0; run < 500; ++run) {
    const double x = place(random);
    const double y = place(random);
    const double z = place(random);
    const motion::Pose pose{{x, y, z}, random.rotation()};
    if (scene.distance_m(pose) > 0.0) continue;
    ++colliding;
    const std::optional<FreePose> found = nearest_free_pose(space, pose, kPoseMargin_m, kAny);
    ASSERT_TRUE(found);
    bool is_beaten = false;
    for (int k = 0; k < 500 && !is_beaten; ++k) {
      const double u = normal(random);
      const double v = normal(random);
      const double w = normal(random);
      const Vec3 step = std::cbrt(0.5 * (1.0 + place(random))) * found->moved_m / kPrecise *
                        Vec3(u, v, w).normalized();
      is_beaten =
          scene.distance_m(motion::Pose{pose.position + step, pose.orientation}) > kPoseMargin_m;
    }
    beaten += is_beaten ? 1 : 0;
  }
  EXPECT_GT(colliding, 20);
  // It is a local search, and corners between many cuboids are narrow.
  EXPECT_LE(beaten, colliding / 20);
}

TEST(NearestFreePose, KeepsTheClearanceToo) {
  scene::Mesh mesh;
  testing::add_parallelogram(mesh, {-50, -50, 0}, {100, 0, 0}, {0, 100, 0});
  SearchScene scene(std::move(mesh), sphere(kSphere_m));
  scene.detect.clearance_m = 0.3;
  FreeSpace space = scene.space();
  const motion::Pose pose = pose_at({0, 0, 0.4});
  const std::optional<FreePose> found = nearest_free_pose(space, pose, kPoseMargin_m, kAny);
  ASSERT_TRUE(found);
  EXPECT_GE(scene.distance_m(found->pose), 0.3 + kPoseMargin_m);
  EXPECT_LE(found->moved_m, kPrecise * (0.1 + kPoseMargin_m));
}

// Plates without an end stand closer than the sphere is wide, as far as they go.
TEST(NearestFreePose, NothingWhereTheBodyIsBuriedBeyondReach) {
  for (const double reach : {0.6, 1.3}) {
    const double end_m = reach * kFreePoseReach * kSphere_m;
    scene::Mesh mesh;
    for (double x_m = -end_m; x_m <= end_m; x_m += kSphere_m)
      testing::add_parallelogram(mesh, {x_m, -50, -50}, {0, 100, 0}, {0, 0, 100});
    const SearchScene scene(std::move(mesh), sphere(kSphere_m));
    FreeSpace space = scene.space();
    const std::optional<FreePose> found =
        nearest_free_pose(space, pose_at(Vec3::Zero()), kPoseMargin_m, kAny);
    EXPECT_EQ(found.has_value(), reach < 1.0);
    if (found) expect_free(scene, pose_at(Vec3::Zero()), *found);
  }
}

TEST(NearestFreePose, IsFreeWhateverTheScene) {
  testing::Random random(2);
  const SearchScene scene(scattered_cuboids(random, 20, 0.6));
  FreeSpace space = scene.space();
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  int colliding = 0;
  for (int run = 0; run < 300; ++run) {
    const double x = place(random);
    const double y = place(random);
    const double z = place(random);
    const motion::Pose pose{{x, y, z}, random.rotation()};
    if (scene.distance_m(pose) > 0.0) continue;
    ++colliding;
    const std::optional<FreePose> found = nearest_free_pose(space, pose, kPoseMargin_m, kAny);
    ASSERT_TRUE(found);
    expect_free(scene, pose, *found);
  }
  EXPECT_GT(colliding, 30);
}

// However far beyond its bounds a pose is, it is brought back straight, and then out of the scene.
TEST(NearestFreePose, BackWithinBounds) {
  const SearchScene empty({}, sphere(kSphere_m));
  geometry::Bounds bounds;
  bounds.max_W = {1.0, 1.0, std::numeric_limits<double>::infinity()};
  FreeSpace space({collision::Obstacles(empty.index).within(bounds), empty.body, empty.detect});
  const auto found = nearest_free_pose(space, pose_at({31, 41, 0}), kPoseMargin_m, kAny);
  ASSERT_TRUE(found);
  const double inset_m = kSphere_m + kPoseMargin_m;
  const double least_m = std::hypot(30.0 + inset_m, 40.0 + inset_m);
  EXPECT_GE(found->moved_m, least_m);
  // On each of two axes the margin, to within the precision.
  EXPECT_LE(found->moved_m, least_m + 2.0 * kFreePosePrecision * kPoseMargin_m);
  EXPECT_EQ(found->pose.position.z(), 0.0);

  scene::Mesh mesh;
  testing::add_cuboid(mesh, {0.5, 0.5, -0.1}, {1.5, 1.5, 0.1});
  const SearchScene scene(std::move(mesh), sphere(kSphere_m));
  FreeSpace blocked({collision::Obstacles(scene.index).within(bounds), scene.body, scene.detect});
  const auto beside = nearest_free_pose(blocked, pose_at({31, 41, 0}), kPoseMargin_m, kAny);
  ASSERT_TRUE(beside);
  EXPECT_GE(scene.distance_m(beside->pose), kPoseMargin_m);
  EXPECT_GE(bounds.depth_m(beside->pose.position), inset_m);
  EXPECT_LT((beside->pose.position - found->pose.position).norm(), 0.5);
}

}  // namespace
}  // namespace camway::correction
