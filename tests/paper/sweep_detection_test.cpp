// SPDX-License-Identifier: MIT
#include "daemon/paper/sweep_detection.h"

#include <gtest/gtest.h>

#include "daemon/motion/spline/interpolate.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::paper {
namespace {

using collision::FirstCollision;
using geometry::Quat;
using geometry::Vec3;
using motion::Corners;
using motion::Keyframe;
using motion::Path;
using scene::Mesh;
using scene::SceneIndex;

Path straight(double z_from, double z_to) {
  return motion::interpolate(std::vector<Keyframe>{{0.0, {{0, 0, z_from}, Quat::Identity()}},
                                                   {1.0, {{0, 0, z_to}, Quat::Identity()}}});
}

FirstCollision sweep(const SceneIndex& index, const Path& path, double from_s = 0.0) {
  return first_sweep_collision(index, path, motion::near_corners_C(testing::small_camera()), from_s,
                               path.end_s(), {}, base::Deadline::never());
}

TEST(SweepDetection, BracketsACuboidInTheWay) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-1, -1, -0.25}, {1, 1, 0.25});
  const SceneIndex index = SceneIndex::build(mesh);
  // The scene is a surface: inside the cuboid the quadrilateral is free again. So the first
  // interval is the entry at z = 0.25.
  const FirstCollision found = sweep(index, straight(2, -2));
  ASSERT_TRUE(found.decided && found.interval);
  const double entry_s = (2.0 - 0.1 - 0.25) / 4.0;
  EXPECT_LE(found.interval->t_begin_s, entry_s);
  EXPECT_GE(found.interval->t_end_s, entry_s);
  EXPECT_NEAR(found.interval->t_begin_s, entry_s, 2e-4);
}

TEST(SweepDetection, AgreesWithTheDistanceBasedCheckOnSides) {
  testing::Random random(21);
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  std::uniform_real_distribution<double> place(-1.2, 1.2);
  int compared = 0;
  for (int run = 0; run < 40; ++run) {
    // Bars longer than the quadrilateral cannot be inside the tube.
    Mesh mesh;
    const double x = 0.12 * place(random);
    testing::add_cuboid(mesh, {x - 0.01, -2, -0.01}, {x + 0.01, 2, 0.01});
    const SceneIndex index = SceneIndex::build(mesh);
    const Path path = motion::interpolate(
        std::vector<Keyframe>{{0.0, {{0, 0, 1}, Quat::Identity()}},
                              {1.0,
                               {{0.1 * place(random), 0.2 * place(random), 0.1},
                                Quat(Eigen::AngleAxisd(0.6 * place(random), Vec3::UnitY()))}},
                              {2.0, {{0, 0, -1}, Quat::Identity()}}});
    const FirstCollision by_distance =
        collision::first_collision({collision::Obstacles(index), motion::Body(corners_C)}, path,
                                   0.0, 2.0, base::Deadline::never());
    const FirstCollision by_sweep = sweep(index, path);
    ASSERT_TRUE(by_distance.decided && by_sweep.decided);
    ASSERT_EQ(by_distance.interval.has_value(), by_sweep.interval.has_value()) << "run " << run;
    if (!by_distance.interval) continue;
    ++compared;
    EXPECT_NEAR(by_distance.interval->t_begin_s, by_sweep.interval->t_begin_s, 2e-3)
        << "run " << run;
  }
  EXPECT_GT(compared, 10);
}

TEST(SweepDetection, FindsAThinPlateCrossedBetweenTwoParameters) {
  Mesh mesh;
  testing::add_triangle(mesh, {-5, -5, 0.013}, {5, -5, 0.013}, {0, 5, 0.013});
  const SceneIndex index = SceneIndex::build(mesh);
  const FirstCollision found = sweep(index, straight(2, -2));
  ASSERT_TRUE(found.decided && found.interval);
  const double instant_s = (2.0 - 0.1 - 0.013) / 4.0;
  EXPECT_LE(found.interval->t_begin_s, instant_s);
  EXPECT_GE(found.interval->t_end_s, instant_s);
}

// The case that the paper's method misses and `first_collision` finds. If this test begins to find
// the cube, the comment on `first_sweep_collision` and the second search in `keyframe_insertion`
// lose their reason.
TEST(SweepDetection, DoesNotSeeWhatTheTubeEncloses) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-0.005, -0.005, -0.005}, {0.005, 0.005, 0.005});
  const SceneIndex index = SceneIndex::build(mesh);
  const FirstCollision found = sweep(index, straight(2, -2));
  EXPECT_TRUE(found.decided);
  EXPECT_FALSE(found.interval);
}

TEST(SweepDetection, WorksOnNegativeTimesAndFromTheMiddle) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-1, -1, 0.95}, {1, 1, 1.05});
  testing::add_cuboid(mesh, {-1, -1, -1.05}, {1, 1, -0.95});
  const SceneIndex index = SceneIndex::build(mesh);
  const Path path = motion::interpolate(std::vector<Keyframe>{
      {-8.0, {{0, 0, 2}, Quat::Identity()}}, {-4.0, {{0, 0, -2}, Quat::Identity()}}});
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const FirstCollision first =
      first_sweep_collision(index, path, corners_C, -8.0, -4.0, {}, base::Deadline::never());
  ASSERT_TRUE(first.decided && first.interval);
  EXPECT_NEAR(first.interval->t_begin_s, -8.0 + (2.0 - 0.1 - 1.05), 1e-3);
  const FirstCollision second =
      first_sweep_collision(index, path, corners_C, -6.5, -4.0, {}, base::Deadline::never());
  ASSERT_TRUE(second.decided && second.interval);
  EXPECT_NEAR(second.interval->t_begin_s, -8.0 + (2.0 - 0.1 + 0.95), 1e-3);
}

}  // namespace
}  // namespace camway::paper
