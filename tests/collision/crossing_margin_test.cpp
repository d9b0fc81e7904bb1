// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "daemon/collision/crossing.h"
#include "daemon/geometry/triangle_intersection.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::collision {
namespace {

using geometry::Triangle;
using geometry::Vec3;

Triangle random_triangle(testing::Random& random, double scale) {
  const Vec3 a = random.in_cube(scale);
  const Vec3 b = random.in_cube(scale);
  return {a, b, random.in_cube(scale)};
}

// The claim of the header: if each corner moves in any direction by no more than the margin, they
// still touch.
TEST(CrossingMargin, SurvivesAnyMotionOfThatSize) {
  testing::Random random(31);
  int margins = 0;
  for (int run = 0; run < 20'000; ++run) {
    const Vec3 place = run % 2 == 0 ? Vec3::Zero() : random.in_cube(1e6);
    Triangle a = random_triangle(random, 1.0);
    Triangle b = random_triangle(random, std::pow(10.0, 2.0 * random.uniform(0.0, 1.0) - 1.0));
    for (Vec3& vertex : a) vertex += place;
    for (Vec3& vertex : b) vertex += place;
    const double margin_m = crossing_margin_m(a, b, 0.0);
    ASSERT_GE(margin_m, 0.0);
    if (margin_m == 0.0) continue;
    ++margins;
    ASSERT_TRUE(geometry::triangles_touch(a, b)) << "run " << run;
    for (int way = 0; way < 20; ++way) {
      Triangle moved = a;
      const Vec3 together = random.direction();
      for (Vec3& vertex : moved) {
        // Moves by the largest allowed distance; rounding of the sum must not exceed it.
        const double allowed_m = margin_m * (1.0 - 1e-9) - 1e-9 * (run % 2 == 0 ? 0.0 : 1.0);
        if (allowed_m <= 0.0) continue;
        vertex += allowed_m * (way % 2 == 0 ? together : random.direction());
      }
      ASSERT_TRUE(geometry::triangles_touch(moved, b)) << "run " << run << ", way " << way;
    }
  }
  std::printf("%d margins\n", margins);
  EXPECT_GT(margins, 1'000);
}

// A rotation of a rigid body counts by the motion of its points.
TEST(CrossingMargin, SurvivesTurns) {
  testing::Random random(32);
  int margins = 0;
  for (int run = 0; run < 20'000; ++run) {
    const Triangle a = random_triangle(random, 1.0);
    const Triangle b = random_triangle(random, 1.0);
    const double margin_m = crossing_margin_m(a, b, 0.0);
    if (!(margin_m > 1e-3)) continue;
    ++margins;
    const Vec3 about = random.in_cube(1.0);
    const Eigen::AngleAxisd turn(0.4 * margin_m * random.uniform(0.0, 1.0), random.direction());
    Triangle moved = a;
    double moved_m = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      moved[i] = about + turn * (a[i] - about);
      moved_m = std::max(moved_m, (moved[i] - a[i]).norm());
    }
    if (moved_m >= margin_m) continue;
    ASSERT_TRUE(geometry::triangles_touch(moved, b)) << "run " << run;
  }
  EXPECT_GT(margins, 500);
}

TEST(CrossingMargin, OfANeedleThroughAPlateIsItsDistanceFromTheBorder) {
  const Triangle plate{{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}}};
  const Triangle needle{{{0, 0, -5}, {0, 0, 5}, {0, 0, 5}}};
  EXPECT_NEAR(crossing_margin_m(needle, plate, 0.0), 1.0, 1e-12);
  const Triangle short_needle{{{0, 0, -5}, {0, 0, 0.25}, {0, 0, 0.25}}};
  EXPECT_NEAR(crossing_margin_m(short_needle, plate, 0.0), 0.25, 1e-12);
  EXPECT_EQ(crossing_margin_m(short_needle, plate, 0.3), 0.0);
}

TEST(CrossingMargin, IsNothingWhereNothingPassesThrough) {
  const Triangle plate{{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}}};
  const Triangle beside{{{-2, 0, -5}, {-2, 0, 5}, {-3, 0, 0}}};
  const Triangle above{{{0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1}}};
  const Triangle touching{{{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0.1}}};
  for (const Triangle& other : {beside, above, touching, plate}) {
    EXPECT_EQ(crossing_margin_m(other, plate, 0.0), 0.0);
  }
}

TEST(CrossingMargin, OfNumbersWithoutMeaningIsNothing) {
  const Triangle plate{{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}}};
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    const Triangle needle{{{0, 0, -5}, {0, bad, 5}, {0, bad, 5}}};
    EXPECT_EQ(crossing_margin_m(needle, plate, 0.0), 0.0);
  }
  const Triangle point{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
  EXPECT_EQ(crossing_margin_m(point, plate, 0.0), 0.0);
}

}  // namespace
}  // namespace camway::collision
