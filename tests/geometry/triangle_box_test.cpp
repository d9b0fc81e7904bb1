// SPDX-License-Identifier: MIT
#include "daemon/geometry/triangle_box.h"

#include <gtest/gtest.h>

#include "daemon/geometry/rounding.h"
#include "tests/geometry/exact_oracle.h"
#include "tests/geometry/random_triangles.h"

namespace camway::geometry {
namespace {

Box random_box(RandomTriangles& random, bool on_grid) {
  Box box;
  for (int i = 0; i < 2; ++i) {
    box.extend(on_grid ? random.on_grid(3) : random.in_cube(random.log_uniform(1e-3, 10.0)));
  }
  return box;
}

TEST(TriangleTouchesBox, IsExactOnAGrid) {
  RandomTriangles random(201);
  int touching = 0;
  for (int i = 0; i < 6000; ++i) {
    const Triangle t = random.grid_triangle(4);
    const Box box = random_box(random, true);
    const bool expected = oracle::touches_box(t, box);
    touching += expected ? 1 : 0;
    // Small integers are computed without rounding, and their distances exceed the margin.
    ASSERT_EQ(triangle_touches_box(t, box), expected)
        << to_text(t) << box.min().transpose() << " " << box.max().transpose();
  }
  EXPECT_GT(touching, 1000);
  EXPECT_LT(touching, 5000);
}

TEST(TriangleTouchesBox, NeverDeniesATouch) {
  RandomTriangles random(202);
  int apart = 0;
  for (int i = 0; i < 6000; ++i) {
    const Box box = random_box(random, false);
    Triangle t = random.thin_triangle();
    // Moves a point of the triangle near a corner, an edge or a side of the box.
    Vec3 target = box.min();
    for (int k = 0; k < 3; ++k) {
      const int where = random.integer(0, 2);
      target[k] = where == 0
                      ? box.min()[k]
                      : (where == 1 ? box.max()[k] : random.uniform(box.min()[k], box.max()[k]));
    }
    target += random.in_cube(box.sizes().maxCoeff() * random.log_uniform(1e-18, 1.0));
    t = moved(t, target - random.point_on(t));
    if (oracle::touches_box(t, box)) {
      ASSERT_TRUE(triangle_touches_box(t, box)) << to_text(t);
    } else if (!triangle_touches_box(t, box)) {
      ++apart;
    }
  }
  EXPECT_GT(apart, 1000);
}

TEST(TriangleTouchesBox, CountsOnlyGapsBelowTheBound) {
  RandomTriangles random(203);
  for (int i = 0; i < 3000; ++i) {
    // A triangle that faces a corner of the box: only its normal separates the two.
    const Vec3 half(random.uniform(0.5, 2.0), random.uniform(0.5, 2.0), random.uniform(0.5, 2.0));
    const Box box(-half, half);
    const Vec3 normal =
        Vec3(random.uniform(0.3, 1.0), random.uniform(0.3, 1.0), random.uniform(0.3, 1.0))
            .normalized();
    const Vec3 e = normal.unitOrthogonal();
    const Vec3 f = normal.cross(e);
    // For a unit normal the bound is a distance. The rounding of the triangle's own vertices and of
    // its computed normal has the same size.
    const double gap = 8.0 * triangle_box_gap_error(normal, 16.0);
    const Vec3 foot = half + gap * normal;
    ASSERT_FALSE(triangle_touches_box(
        {foot + 4.0 * e, foot - 3.0 * e + 3.0 * f, foot - 3.0 * e - 3.0 * f}, box));
    const Vec3 inside = half - gap * normal;
    ASSERT_TRUE(triangle_touches_box(
        {inside + 4.0 * e, inside - 3.0 * e + 3.0 * f, inside - 3.0 * e - 3.0 * f}, box));
  }
}

TEST(TriangleTouchesBox, NothingTouchesAnEmptyBox) {
  EXPECT_FALSE(triangle_touches_box({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, Box()));
}

TEST(TriangleTouchesBox, HoldsItsAnswerFarFromTheOrigin) {
  RandomTriangles random(204);
  const Vec3 far(0x1p20, -0x1p20, 0x1p19);
  for (int i = 0; i < 2000; ++i) {
    const Triangle t = random.grid_triangle(4);
    const Box box = random_box(random, true);
    const Box moved_box(box.min() + far, box.max() + far);
    ASSERT_EQ(triangle_touches_box(moved(t, far), moved_box), triangle_touches_box(t, box));
  }
}

TEST(SquaredBoxDistance, IsThatOfTheClosestPoints) {
  RandomTriangles random(205);
  for (int i = 0; i < 2000; ++i) {
    const Box a = random_box(random, true);
    const Box b = random_box(random, true);
    Vec3 closest_a = a.min();
    Vec3 closest_b = b.min();
    for (int k = 0; k < 3; ++k) {
      closest_b[k] = std::clamp(a.min()[k], b.min()[k], b.max()[k]);
      closest_a[k] = std::clamp(closest_b[k], a.min()[k], a.max()[k]);
    }
    // Small integers: no rounding.
    EXPECT_EQ(squared_box_distance_m2(a, b), (closest_a - closest_b).squaredNorm());
    EXPECT_EQ(squared_box_distance_m2(b, a), squared_box_distance_m2(a, b));
  }
}

}  // namespace
}  // namespace camway::geometry
