// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "daemon/collision/crossing.h"
#include "daemon/geometry/triangle_intersection.h"
#include "tests/support/scenes.h"

namespace camway::collision {
namespace {

using geometry::Triangle;
using geometry::Vec3;

class RandomTriangles {
 public:
  explicit RandomTriangles(std::uint64_t seed) : random_(testing::seeded(seed)) {}

  Vec3 point(double scale) {
    return {scale * even_(random_), scale * even_(random_), scale * even_(random_)};
  }
  Triangle triangle(double scale) { return {point(scale), point(scale), point(scale)}; }
  Vec3 direction() { return point(1.0).normalized(); }
  double share() { return 0.5 * (even_(random_) + 1.0); }
  geometry::Quat rotation() { return testing::random_rotation(random_); }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> even_{-1.0, 1.0};
};

// The claim of the header: if each corner moves in any direction by no more than the margin, they
// still touch.
TEST(CrossingMargin, SurvivesAnyMotionOfThatSize) {
  RandomTriangles random(31);
  int margins = 0;
  for (int run = 0; run < 20'000; ++run) {
    const Vec3 place = run % 2 == 0 ? Vec3::Zero() : random.point(1e6);
    Triangle a = random.triangle(1.0);
    Triangle b = random.triangle(std::pow(10.0, 2.0 * random.share() - 1.0));
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
  RandomTriangles random(32);
  int margins = 0;
  for (int run = 0; run < 20'000; ++run) {
    const Triangle a = random.triangle(1.0);
    const Triangle b = random.triangle(1.0);
    const double margin_m = crossing_margin_m(a, b, 0.0);
    if (!(margin_m > 1e-3)) continue;
    ++margins;
    const Vec3 about = random.point(1.0);
    const Eigen::AngleAxisd turn(0.4 * margin_m * random.share(), random.direction());
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
