// SPDX-License-Identifier: MIT
#include "daemon/correction/search/ball_escape.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/correction/search_scene.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file

// A part of a step that is larger than its rounding.
constexpr double kEscapeRounding = 1e-9;

/// A plate of 10 cm in the plane z = 0, and a camera that looks along z, `share` of its radius
/// above the plate. With `gap_share`, a second plate is above the first, so much of the radius
/// apart.
struct EscapeScene {
  explicit EscapeScene(double share, std::optional<double> gap_share = std::nullopt)
      : scene(plates(gap_share)), space(scene.space()) {
    const Vec3 center_W(0.1, 0.2, 0.05 + share * space.ball_radius_m());
    pose = motion::signed_pose(space.pose_around(center_W, Quat::Identity()));
  }

  static scene::Mesh plates(std::optional<double> gap_share) {
    scene::Mesh mesh = wall_with_gap(20.0, 21.0);
    if (!gap_share) return mesh;
    const SearchScene alone(mesh);
    const double z_m = 0.05 + *gap_share * alone.space().ball_radius_m();
    testing::add_cuboid(mesh, {-30, -30, z_m}, {30, 30, z_m + 0.1});
    return mesh;
  }

  [[nodiscard]] double ball_gap_m(const SignedPose& at) const {
    return space.ball_gap_m(space.center_W(motion::unsigned_pose(at)), space.ball_radius_m(), 1.0);
  }

  SearchScene scene;
  FreeSpace space;
  SignedPose pose;
};

TEST(BallEscape, StaysWhereTheBallIsFree) {
  EscapeScene c(1.1);
  const std::optional<SignedPose> there = ball_escape(c.space, c.pose, c.space.ball_radius_m());
  ASSERT_TRUE(there);
  EXPECT_TRUE(same({*there}, {c.pose}));
}

TEST(BallEscape, LeadsStraightToTheNearestPlaceThatItTries) {
  EscapeScene c(0.3);
  ASSERT_LT(c.ball_gap_m(c.pose), 0.0);
  const double radius_m = c.space.ball_radius_m();
  const std::optional<SignedPose> there = ball_escape(c.space, c.pose, radius_m);
  ASSERT_TRUE(there);
  EXPECT_GT(c.ball_gap_m(*there), 0.0);
  EXPECT_EQ(there->orientation, c.pose.orientation);
  // Half a radius is not enough in any direction, and one radius is enough in some.
  EXPECT_NEAR((there->position - c.pose.position).norm(), radius_m, kEscapeRounding * radius_m);
  EXPECT_TRUE(is_proved_free(c.scene, {c.pose, *there}, 0.0));
}

TEST(BallEscape, NeedsNoMoveForASmallerBall) {
  EscapeScene c(0.3);
  const std::optional<SignedPose> there =
      ball_escape(c.space, c.pose, 0.2 * c.space.ball_radius_m());
  ASSERT_TRUE(there);
  EXPECT_TRUE(same({*there}, {c.pose}));
}

// The places beyond the plates have room, but no free motion leads there.
TEST(BallEscape, FindsNothingBetweenPlatesThatAreNear) {
  EscapeScene c(0.3, 0.6);
  EXPECT_FALSE(ball_escape(c.space, c.pose, c.space.ball_radius_m()));
}

}  // namespace
}  // namespace camway::correction
