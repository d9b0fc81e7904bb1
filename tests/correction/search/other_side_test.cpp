// SPDX-License-Identifier: MIT
#include "daemon/correction/search/other_side.h"

#include <gtest/gtest.h>

#include <vector>

namespace camway::correction {
namespace {

using geometry::Vec3;

const std::vector<Vec3> kStraight_W = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};

/// A way beside the straight one, whose apex is at (2, 0, `away_m`).
LatticeResult way_off(double away_m) {
  LatticeResult way;
  way.way_W = {{0, 0, 0}, {1, 0, 0.5 * away_m}, {2, 0, away_m}, {3, 0, 0}};
  way.cost_m = 5.0;
  way.points = 100;
  return way;
}

TEST(OtherSide, TheApexIsThePointFarthestFromThePolyline) {
  const Apex apex = apex_of(way_off(2.0).way_W, kStraight_W);
  EXPECT_EQ(apex.place_W, Vec3(2, 0, 2));
  EXPECT_EQ(apex.away_m, 2.0);
  EXPECT_EQ(apex_of(kStraight_W, kStraight_W).away_m, 0.0);
}

TEST(OtherSide, AvoidsTheApexByTheBodyOrByItsDistance) {
  const OtherSide side(way_off(2.0), kStraight_W);
  for (const double radius_m : {0.1, 10.0}) {
    const BallMotion ball = side.limited({.radius_m = radius_m, .from_W = {0, 0, 0}});
    ASSERT_EQ(ball.avoided.size(), 1U);
    EXPECT_EQ(ball.avoided[0].center_W, Vec3(2, 0, 2));
    EXPECT_GT(ball.avoided[0].radius_m, radius_m);
    // The path itself stays outside of what a small ball avoids.
    if (radius_m < 1.0) {
      EXPECT_LT(ball.avoided[0].radius_m, 2.0);
    }
  }
}

TEST(OtherSide, LimitsTheSearchByWhatTheFirstWayTook) {
  const OtherSide side(way_off(2.0), kStraight_W);
  const BallMotion ball = side.limited({.radius_m = 0.3, .from_W = {0, 1, 0}, .to_W = {3, 1, 0}});
  EXPECT_EQ(ball.radius_m, 0.3);
  EXPECT_EQ(ball.from_W, Vec3(0, 1, 0));
  EXPECT_EQ(ball.to_W, Vec3(3, 1, 0));
  EXPECT_GT(ball.max_cost_m, 5.0);
  EXPECT_LT(ball.max_cost_m, 10.0);
  EXPECT_GT(ball.max_points, 100U);
  EXPECT_LT(ball.max_points, 1000U);
  EXPECT_GT(ball.coarseness, 1.0);
  EXPECT_LT(ball.coarseness, 2.0);
}

TEST(OtherSide, DrawsNoWayThatLeadsMuchFartherOff) {
  const OtherSide side(way_off(2.0), kStraight_W);
  EXPECT_FALSE(side.is_too_far(way_off(1.0)));
  EXPECT_FALSE(side.is_too_far(way_off(2.1)));
  EXPECT_TRUE(side.is_too_far(way_off(4.0)));
}

}  // namespace
}  // namespace camway::correction
