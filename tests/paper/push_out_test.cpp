// SPDX-License-Identifier: MIT
#include "daemon/paper/push_out.h"

#include <gtest/gtest.h>

#include "daemon/collision/near_quad.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::paper {
namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::Corners;
using motion::Pose;
using scene::Mesh;
using scene::SceneIndex;

constexpr double kMargin_m = 1e-3;

// Returns corners at (±0.1, ±0.0577, -0.1).
Corners small_corners_C() { return motion::near_corners_C(testing::small_camera()); }

SceneIndex wall_right_of(double x) {
  Mesh mesh;
  testing::add_triangle(mesh, {x, -50, -50}, {x, 50, -50}, {x, 0, 80});
  return SceneIndex::build(mesh);
}

TEST(PushOutRule, AWallAcrossTheRightSideMakesTheRightCornersBad) {
  const SceneIndex index = wall_right_of(0.04);
  const PushOutRule rule = push_out_rule(index, small_corners_C(), {});
  // Order: (+x,+y), (-x,+y), (-x,-y), (+x,-y).
  EXPECT_EQ(rule.bad, (std::array<bool, 4>{true, false, false, true}));
  EXPECT_LT(rule.direction_W.x(), 0.0);
  EXPECT_NEAR(rule.direction_W.y(), 0.0, 1e-15);
  EXPECT_NEAR(rule.direction_W.z(), 0.0, 1e-15);
  // From each right corner along the horizontal edge to the wall; the vertical edges hit nothing.
  EXPECT_NEAR(rule.depth_m[0], 0.06, 1e-12);
  EXPECT_NEAR(rule.depth_m[3], 0.06, 1e-12);
  EXPECT_EQ(rule.depth_m[1], 0.0);
  EXPECT_NEAR(rule.largest_depth_m(), 0.06, 1e-12);
}

// Figure 4 of the paper: the depth of a bad corner is the larger distance on its two edges, and the
// depth of the collision is the largest depth of a corner.
TEST(PushOutRule, DepthIsTheLargerOfTheTwoEdges) {
  Mesh mesh;
  // A vertical plane cuts off the corner (+x,+y) at 0.08 on the upper and 0.02 on the right edge.
  const double y_top = small_corners_C()[0].y();
  const Vec3 on_top(0.1 - 0.08, y_top, -0.1);
  const Vec3 on_right(0.1, y_top - 0.02, -0.1);
  const Vec3 along = (on_right - on_top) * 100.0;
  testing::add_triangle(mesh, on_top - along + Vec3(0, 0, -10), on_right + along + Vec3(0, 0, -10),
                        0.5 * (on_top + on_right) + Vec3(0, 0, 30));
  const PushOutRule rule = push_out_rule(SceneIndex::build(mesh), small_corners_C(), {});
  EXPECT_EQ(rule.bad, (std::array<bool, 4>{true, false, false, false}));
  EXPECT_NEAR(rule.depth_m[0], 0.08, 1e-9);
  // Away from the only bad corner.
  EXPECT_LT(rule.direction_W.x(), 0.0);
  EXPECT_LT(rule.direction_W.y(), 0.0);
}

TEST(PushOutRule, ABadCornerWithClearEdgesTakesItsDepthFromTheCentre) {
  Mesh mesh;
  const Vec3 between = 0.5 * small_corners_C()[0] + Vec3(0, 0, -0.05);
  testing::add_cuboid(mesh, between - Vec3::Constant(0.004), between + Vec3::Constant(0.004));
  const PushOutRule rule = push_out_rule(SceneIndex::build(mesh), small_corners_C(), {});
  EXPECT_EQ(rule.bad, (std::array<bool, 4>{true, false, false, false}));
  EXPECT_GT(rule.depth_m[0], 0.04);
  EXPECT_LT(rule.depth_m[0], 0.06);
}

TEST(PushOut, EndsFreeWithTheMarginAndKeepsTheOrientation) {
  testing::Random random(3);
  std::uniform_real_distribution<double> where(-0.04, 0.05);
  int pushed_out = 0;
  for (int run = 0; run < 200; ++run) {
    const SceneIndex index = wall_right_of(where(random));
    const Quat turn(Eigen::AngleAxisd(where(random) * 4.0, Vec3::UnitY()));
    const PushOut result = push_out(index, small_corners_C(), {Vec3::Zero(), turn}, kMargin_m);
    if (result.outcome != PushOutOutcome::kFree) continue;
    ++pushed_out;
    EXPECT_FALSE(collision::clearance_m(index, small_corners_C(), result.pose, kMargin_m));
    EXPECT_EQ(result.pose.orientation.coeffs(), turn.coeffs());
    EXPECT_GT(result.steps, 0);
  }
  EXPECT_GT(pushed_out, 150);
}

TEST(PushOut, AFreePoseStaysAsItIs) {
  const PushOut result = push_out(wall_right_of(5.0), small_corners_C(), {}, kMargin_m);
  EXPECT_EQ(result.outcome, PushOutOutcome::kFree);
  EXPECT_EQ(result.steps, 0);
  EXPECT_EQ(result.pose.position, Vec3::Zero());
}

TEST(PushOut, HasNoDirectionWhereTheRuleGivesNone) {
  Mesh inside;  // touches the quadrilateral, but no segment from its centre to a corner
  testing::add_cuboid(inside, {0.05, -0.005, -0.105}, {0.06, 0.005, -0.095});
  EXPECT_EQ(push_out(SceneIndex::build(inside), small_corners_C(), {}, kMargin_m).outcome,
            PushOutOutcome::kNoDirection);

  Mesh across;  // a pole through the centre: every corner is bad
  testing::add_cuboid(across, {-0.005, -0.005, -1}, {0.005, 0.005, 1});
  EXPECT_EQ(push_out(SceneIndex::build(across), small_corners_C(), {}, kMargin_m).outcome,
            PushOutOutcome::kNoDirection);

  Mesh opposite;  // two poles through opposite corners: the good ones cancel
  for (const Vec3& corner : {small_corners_C()[0], small_corners_C()[2]}) {
    const Vec3 at = 0.8 * corner;
    testing::add_cuboid(opposite, {at.x() - 0.005, at.y() - 0.005, -1},
                        {at.x() + 0.005, at.y() + 0.005, 1});
  }
  EXPECT_EQ(push_out(SceneIndex::build(opposite), small_corners_C(), {}, kMargin_m).outcome,
            PushOutOutcome::kNoDirection);
}

TEST(PushOut, IsCutOffBetweenTwoWallsCloserThanTheCamera) {
  Mesh mesh;
  for (const double x : {-0.05, 0.06})
    testing::add_triangle(mesh, {x, -50, -50}, {x, 50, -50}, {x, 0, 80});
  const PushOut result = push_out(SceneIndex::build(mesh), small_corners_C(),
                                  {{0.03, 0, 0}, Quat::Identity()}, kMargin_m);
  EXPECT_NE(result.outcome, PushOutOutcome::kFree);
}

}  // namespace
}  // namespace camway::paper
