// SPDX-License-Identifier: MIT
#include "daemon/collision/clearance.h"

#include <gtest/gtest.h>

#include "daemon/collision/detect.h"
#include "daemon/collision/near_quad.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::collision {
namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::Corners;
using motion::Keyframe;
using motion::Path;
using scene::Mesh;
using scene::SceneIndex;

PathClearance clearance(const SceneIndex& index, const Path& path, const Corners& corners_C) {
  return path_clearance(Obstacles(index), path, motion::Body(corners_C), base::Deadline::never())
      .value_or(PathClearance{-1.0, -1.0});
}

bool detect_free(const SceneIndex& index, const Path& path, const Corners& corners_C) {
  const auto found = detect_collisions({Obstacles(index), motion::Body(corners_C)}, path,
                                       path.begin_s(), path.end_s(), base::Deadline::never());
  return found && found->empty();
}

TEST(PathClearance, OfAPassBesideAWallIsKnown) {
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  for (const double distance_m : {10.0, 1.0, 0.03, 1e-3, 1e-6}) {
    Mesh mesh;
    const double wall_x = corners_C[0].x() + distance_m;
    testing::add_triangle(mesh, {wall_x, -90, -90}, {wall_x, 90, -90}, {wall_x, 0, 90});
    const Path path =
        motion::interpolate(std::vector<Keyframe>{{0.0, {{-0.5, 0, 1}, Quat::Identity()}},
                                                  {1.0, {{0, 0, 0}, Quat::Identity()}},
                                                  {2.0, {{-0.5, 0, -1}, Quat::Identity()}}});
    const PathClearance found = clearance(SceneIndex::build(mesh), path, corners_C);
    EXPECT_LE(found.lower_bound_m, distance_m);
    EXPECT_GE(found.lower_bound_m, (1.0 - kClearanceTolerance) * distance_m * 0.999);
    EXPECT_GE(found.upper_bound_m, distance_m * 0.999999);
  }
}

// The oracle is dense sampling, with the distance by brute force over all triangles.
TEST(PathClearance, IsNeverAboveWhatSamplesFind) {
  constexpr double kComputed_m = 1e-9;
  testing::Random random(77);
  std::uniform_real_distribution<double> place(-1.2, 1.2);
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  int positive = 0;
  for (int run = 0; run < 30; ++run) {
    const SceneIndex index = SceneIndex::build(testing::scattered_triangles(random, 12, 0.1));
    std::vector<Keyframe> keyframes;
    for (int i = 0; i < 3; ++i) {
      keyframes.push_back({static_cast<double>(i),
                           {{place(random), place(random), place(random)}, random.rotation()}});
    }
    const Path path = motion::interpolate(keyframes);
    const PathClearance found = clearance(index, path, corners_C);
    double sampled_m = kLargestClearance_m;
    for (int i = 0; i <= 1000; ++i) {
      const std::optional<double> gap_m =
          clearance_m(index, corners_C, path.pose(2.0 * i / 1000), sampled_m);
      sampled_m = gap_m.value_or(sampled_m);
    }
    EXPECT_LE(found.lower_bound_m, sampled_m) << "run " << run;
    EXPECT_NEAR(clearance_m(index, corners_C, path.pose(found.closest_s), kLargestClearance_m)
                    .value_or(kLargestClearance_m),
                found.upper_bound_m, kComputed_m)
        << "run " << run;
    const bool free = detect_free(index, path, corners_C);
    EXPECT_EQ(found.lower_bound_m > 0.0, free) << "run " << run;
    if (!free) continue;
    ++positive;
    // Between two samples the body moves by at most a few millimetres.
    EXPECT_GE(found.lower_bound_m, (1.0 - kClearanceTolerance) * (sampled_m - 0.01))
        << "run " << run;
  }
  EXPECT_GT(positive, 3);
}

TEST(PathClearance, IsZeroForACollision) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-0.005, -0.005, -0.005}, {0.005, 0.005, 0.005});
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const Path path = motion::interpolate(std::vector<Keyframe>{
      {0.0, {{0, 0, 1}, Quat::Identity()}}, {1.0, {{0, 0, -1}, Quat::Identity()}}});
  EXPECT_EQ(clearance(SceneIndex::build(mesh), path, corners_C).lower_bound_m, 0.0);
}

TEST(PathClearance, HoldsFarFromTheOriginAndForTinyCameras) {
  motion::Camera camera = testing::small_camera();
  camera.near_m = 1e-3;
  const Corners corners_C = motion::near_corners_C(camera);
  const Vec3 far(1e6, -1e6, 1e6);
  const double distance_m = 0.02;
  Mesh mesh;
  const double wall_x = far.x() + corners_C[0].x() + distance_m;
  testing::add_triangle(mesh, {wall_x, far.y() - 9, far.z() - 9},
                        {wall_x, far.y() + 9, far.z() - 9}, {wall_x, far.y(), far.z() + 9});
  const Path path =
      motion::interpolate(std::vector<Keyframe>{{0.0, {far + Vec3(0, 0, 1), Quat::Identity()}},
                                                {1.0, {far - Vec3(0, 0, 1), Quat::Identity()}}});
  const PathClearance found = clearance(SceneIndex::build(mesh), path, corners_C);
  // A coordinate of 1e6 m is stored to 1e-10 m.
  EXPECT_LE(found.lower_bound_m, distance_m + 1e-9);
  EXPECT_GE(found.lower_bound_m, 0.99 * (1.0 - kClearanceTolerance) * distance_m);
}

// Where the distance is a few roundings, shorter stretches do not help, and so it is measured all
// along the path.
TEST(PathClearance, IsKnownWhereItIsAFewRoundings) {
  constexpr double kStored_m = 2e-10;  // of coordinates of 1e6 m
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const Vec3 far(1e6, -1e6, 1e6);
  const Path path =
      motion::interpolate(std::vector<Keyframe>{{0.0, {far + Vec3(0, 0, 1e-5), Quat::Identity()}},
                                                {1.0, {far - Vec3(0, 0, 1e-5), Quat::Identity()}}});
  for (const double distance_m : {1e-8, 2e-8, 4e-8, 1e-7}) {
    Mesh mesh;
    const double wall_x = far.x() + corners_C[0].x() + distance_m;
    testing::add_triangle(mesh, {wall_x, far.y() - 9, far.z() - 9},
                          {wall_x, far.y() + 9, far.z() - 9}, {wall_x, far.y(), far.z() + 9});
    const PathClearance found = clearance(SceneIndex::build(mesh), path, corners_C);
    EXPECT_LE(found.lower_bound_m, distance_m + kStored_m);
    EXPECT_GT(found.lower_bound_m, 0.4 * distance_m);
  }
}

TEST(PathClearance, IsUndecidedWhenTheDeadlineStrikes) {
  const Path path = motion::interpolate(std::vector<Keyframe>{
      {0.0, {{0, 0, 1}, Quat::Identity()}}, {1.0, {{0, 0, -1}, Quat::Identity()}}});
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  EXPECT_FALSE(path_clearance(Obstacles(SceneIndex::build(Mesh{})), path, motion::Body(corners_C),
                              base::Deadline::after_s(0.0)));
}

}  // namespace
}  // namespace camway::collision
