// SPDX-License-Identifier: MIT
#include "daemon/correction/search/small_ball_way.h"

#include <gtest/gtest.h>

#include "tests/correction/search_scene.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file
using base::Deadline;

constexpr std::size_t kSmallBallCells = 100'000;
constexpr double kSmallShare = 0.2;
// A part of the ball's radius that is larger than the rounding of distances of a few metres.
constexpr double kSmallBallRounding = 1e-9;

SignedPose pose_about(const FreeSpace& space, const Vec3& center_W) {
  return motion::signed_pose(space.pose_around(center_W, Quat::Identity()));
}

Vec3 center_of(const FreeSpace& space, const SignedPose& pose) {
  return space.center_W(motion::unsigned_pose(pose));
}

TEST(SmallBallWay, LeadsThroughAGapThatIsTooNarrowForTheBody) {
  const SearchScene scene(wall_with_gap(-0.05, 0.05), sphere(0.1));
  FreeSpace space = scene.space();
  const SignedPose from = pose_about(space, {-0.3, 0.1, 0.6});
  const SignedPose to = pose_about(space, {0.4, 0.0, -0.5});
  const CellResult found =
      small_ball_way(space, from, to, kSmallShare, kSmallBallCells, Deadline::never());
  ASSERT_GE(found.way_W.size(), 3U);
  EXPECT_EQ(found.way_W.front(), center_of(space, from));
  EXPECT_EQ(found.way_W.back(), center_of(space, to));
  const double ball_m = kSmallShare * space.ball_radius_m();
  for (std::size_t i = 1; i < found.way_W.size(); ++i) {
    const double gap_m = scene.least_m({found.way_W[i - 1], found.way_W[i], found.way_W[i]});
    EXPECT_GE(gap_m, ball_m * (1.0 - kSmallBallRounding)) << "leg " << i;
  }
}

// A camera that looks at the wall may be nearer to it than the ball.
TEST(SmallBallWay, JoinsPosesAtWhichTheBallCollides) {
  const SearchScene scene(wall_with_gap(20.0, 21.0));
  FreeSpace space = scene.space();
  const double radius_m = space.ball_radius_m();
  constexpr double kShare = 0.45;
  const double ball_m = kShare * radius_m;
  const SignedPose from = pose_about(space, {0.1, 0.2, 0.05 + 0.4 * radius_m});
  const SignedPose to = pose_about(space, {0.1, 0.2, 1.5});
  ASSERT_LT(space.ball_gap_m(center_of(space, from), ball_m, 1.0), 0.0);
  const CellResult found =
      small_ball_way(space, from, to, kShare, kSmallBallCells, Deadline::never());
  ASSERT_GE(found.way_W.size(), 4U);
  EXPECT_EQ(found.way_W.front(), center_of(space, from));
  EXPECT_EQ(found.way_W.back(), center_of(space, to));
  for (std::size_t i = 1; i < found.way_W.size(); ++i)
    EXPECT_GT(space.ball_gap_m(found.way_W[i], ball_m, 1.0), 0.0) << i;
}

TEST(SmallBallWay, IsEmptyWhereTheBallFindsNoFreePlace) {
  scene::Mesh mesh = wall_with_gap(20.0, 21.0);
  const double radius_m = SearchScene(mesh).space().ball_radius_m();
  testing::add_cuboid(mesh, {-30, -30, 0.05 + 0.6 * radius_m}, {30, 30, 0.15 + 0.6 * radius_m});
  const SearchScene scene(mesh);
  FreeSpace space = scene.space();
  const SignedPose between = pose_about(space, {0.1, 0.2, 0.05 + 0.3 * radius_m});
  const SignedPose outside = pose_about(space, {0.1, 0.2, -1.5});
  const CellResult found =
      small_ball_way(space, between, outside, 1.0, kSmallBallCells, Deadline::never());
  EXPECT_TRUE(found.way_W.empty());
  EXPECT_FALSE(found.exhausted);
  EXPECT_FALSE(found.pocket);
  EXPECT_EQ(found.cells, 0U);
}

}  // namespace
}  // namespace camway::correction
