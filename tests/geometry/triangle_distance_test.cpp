// SPDX-License-Identifier: MIT
#include "daemon/geometry/triangle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/geometry/triangle_intersection.h"
#include "tests/geometry/exact_oracle.h"
#include "tests/geometry/random_triangles.h"
#include "tests/support/sanitizer.h"

namespace camway::geometry {
namespace {

/// Checks one pair against the oracle. Returns the error as a multiple of the stated bound.
double error_of(const Triangle& a, const Triangle& b) {
  const double computed = triangle_distance(a, b);
  const double exact = oracle::distance_m(a, b);
  EXPECT_EQ(computed == 0.0, exact == 0.0) << to_text(a) << "| " << to_text(b);
  const double relative = std::abs(computed - exact) / triangle_distance_error_m(a, b);
  EXPECT_LE(relative, 1.0) << to_text(a) << "| " << to_text(b) << computed << " " << exact;
  return relative;
}

void report(double worst) { std::printf("worst error: %.4f of the bound\n", worst); }

TEST(TriangleDistance, StaysWithinItsBoundForThinAndNearPairs) {
  RandomTriangles random(301);
  double worst = 0.0;
  for (int i = 0; i < testing::runs(4000) && !::testing::Test::HasFailure(); ++i) {
    const auto [a, b] = random.close_pair();
    worst = std::max(worst, error_of(a, b));
  }
  report(worst);
}

TEST(TriangleDistance, StaysWithinItsBoundForFarPairs) {
  RandomTriangles random(302);
  double worst = 0.0;
  for (int i = 0; i < testing::runs(2000) && !::testing::Test::HasFailure(); ++i) {
    const Triangle a = random.thin_triangle();
    const Triangle b = moved(random.thin_triangle(), random.in_cube(random.log_uniform(1e-6, 1e6)));
    worst = std::max(worst, error_of(a, b));
  }
  report(worst);
}

TEST(TriangleDistance, StaysWithinItsBoundForEdgesNearlyParallel) {
  RandomTriangles random(303);
  double worst = 0.0;
  for (int i = 0; i < testing::runs(3000) && !::testing::Test::HasFailure(); ++i) {
    // Two ridges that cross at a small angle and a small distance.
    const double angle = random.log_uniform(1e-18, 1e-3);
    const double gap = random.log_uniform(1e-18, 1.0);
    const Vec3 along = random.in_cube(1.0).normalized();
    const Vec3 up = along.unitOrthogonal();
    const Vec3 turned = along + angle * along.cross(up);
    const Vec3 base = random.in_cube(1.0);
    const double shift = random.uniform(-1.0, 1.0);
    const Triangle a = {base - along, base + along, base - up};
    const Vec3 crossing = base + shift * along + gap * up;
    const Triangle b = {crossing - turned, crossing + turned, crossing + up};
    worst = std::max(worst, error_of(a, b));
  }
  report(worst);
}

TEST(TriangleDistance, IsExactlyZeroWhereTheyTouch) {
  RandomTriangles random(304);
  double worst = 0.0;
  for (int i = 0; i < testing::runs(3000) && !::testing::Test::HasFailure(); ++i) {
    worst = std::max(worst, error_of(random.grid_triangle(3), random.grid_triangle(3)));
  }
  report(worst);
}

TEST(TriangleDistance, StaysWithinItsBoundFarFromTheOrigin) {
  RandomTriangles random(305);
  double worst = 0.0;
  for (int i = 0; i < testing::runs(1500) && !::testing::Test::HasFailure(); ++i) {
    const auto [a, b] = random.close_pair();
    const Vec3 far = 1e6 * random.in_cube(1.0);
    // The bound is relative to the pair, not to its distance from the origin.
    worst = std::max(worst, error_of(moved(a, far), moved(b, far)));
  }
  report(worst);
}

TEST(TriangleDistance, DependsOnTheOrderOfArgumentsAndVerticesByRoundingOnly) {
  RandomTriangles random(306);
  for (int i = 0; i < 300; ++i) {
    const auto [a, b] = random.close_pair();
    const double expected = triangle_distance(a, b);
    for (const Triangle& pa : vertex_orders(a)) {
      for (const Triangle& pb : vertex_orders(b)) {
        const double either = triangle_distance_error_m(a, b) + triangle_distance_error_m(pa, pb);
        ASSERT_NEAR(triangle_distance(pa, pb), expected, either) << to_text(pa) << to_text(pb);
        ASSERT_NEAR(triangle_distance(pb, pa), expected,
                    triangle_distance_error_m(a, b) + triangle_distance_error_m(pb, pa));
        ASSERT_EQ(triangle_distance(pa, pb) == 0.0, expected == 0.0);
      }
    }
  }
}

TEST(TriangleDistance, IsTheSameUpToALimitAndNoLessBeyondIt) {
  RandomTriangles random(309);
  int given_up = 0;
  for (int run = 0; run < 100'000; ++run) {
    const auto [a, b] = random.close_pair();
    const double distance_m = triangle_distance(a, b);
    // Sometimes exactly at the limit.
    const double limit_m = run % 5 == 0 ? distance_m : random.uniform(0.0, 2.0) * distance_m;
    const double limited_m = triangle_distance(a, b, limit_m);
    if (std::isinf(limited_m)) {
      ++given_up;
      ASSERT_GT(distance_m, limit_m) << "run " << run;
    } else {
      ASSERT_EQ(limited_m, distance_m) << "run " << run;
    }
  }
  EXPECT_GT(given_up, 10'000);
}

TEST(TriangleGap, ItsDirectionIsThatOfTheWidestSlab) {
  RandomTriangles random(310);
  int far = 0;
  for (int run = 0; run < 20'000; ++run) {
    const auto [a, b] = random.close_pair();
    const TriangleGap gap = triangle_gap(a, b, std::numeric_limits<double>::infinity());
    const double error_m = triangle_distance_error_m(a, b);
    ASSERT_EQ(gap.distance_m, triangle_distance(a, b));
    // For close triangles the direction is less certain than the distance, by a square root.
    if (gap.distance_m > 1e12 * error_m) {
      ++far;
      ASSERT_NEAR(slab_width_m(a, b, gap.direction), gap.distance_m, 1e-3 * gap.distance_m);
    }
    // No direction gives a larger distance.
    const Vec3 any = random.in_cube(random.log_uniform(1e-6, 1e3));
    ASSERT_LE(slab_width_m(a, b, any), gap.distance_m + error_m) << to_text(a) << to_text(b);
    ASSERT_LE(slab_width_m(a, b, gap.direction), gap.distance_m + error_m);
  }
  EXPECT_GT(far, 1000);
}

TEST(SlabWidth, OfADirectionWithoutLengthIsNone) {
  RandomTriangles random(311);
  const auto [a, b] = random.close_pair();
  EXPECT_EQ(slab_width_m(a, b, Vec3::Zero()), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(slab_width_m(a, b, 0x1p-300 * Vec3::UnitX()), -std::numeric_limits<double>::infinity());
}

TEST(TriangleDistance, ScalesByPowersOfTwo) {
  RandomTriangles random(307);
  for (const double unit : {0x1p-900, 0x1p-300, 0x1p150, 0x1p199}) {
    for (int i = 0; i < 200; ++i) {
      Triangle a = random.grid_triangle(3);
      Triangle b = random.grid_triangle(3);
      const double expected = triangle_distance(a, b);
      const double error = triangle_distance_error_m(a, b);
      for (Vec3& v : a) v *= unit;
      for (Vec3& v : b) v *= unit;
      ASSERT_NEAR(triangle_distance(a, b) / unit, expected, 2.0 * error);
    }
  }
}

}  // namespace
}  // namespace camway::geometry
