// SPDX-License-Identifier: MIT
#include "daemon/geometry/triangle_intersection.h"

#include <gtest/gtest.h>

#include "daemon/geometry/exact_triangles.h"
#include "tests/geometry/exact_oracle.h"
#include "tests/geometry/random_triangles.h"
#include "tests/support/sanitizer.h"

namespace camway::geometry {
namespace {

TEST(TrianglesTouch, AgreesWithTheExactDistanceOnAGrid) {
  RandomTriangles random(101);
  int touching = 0;
  for (int i = 0; i < testing::runs(4000); ++i) {
    const Triangle a = random.grid_triangle(3);
    const Triangle b = random.grid_triangle(3);
    const bool expected = oracle::squared_distance(a, b) == 0;
    touching += expected ? 1 : 0;
    ASSERT_EQ(triangles_touch(a, b), expected) << to_text(a) << "| " << to_text(b);
    ASSERT_EQ(triangles_touch_exactly(a, b), expected) << to_text(a) << "| " << to_text(b);
  }
  // Both answers occur.
  EXPECT_GT(touching, testing::runs(800));
  EXPECT_LT(touching, 3200);
}

TEST(TrianglesTouch, AgreesWithTheExactDistanceOfDegeneratePairs) {
  RandomTriangles random(102);
  for (int i = 0; i < testing::runs(4000); ++i) {
    Triangle a = random.grid_triangle(3);
    Triangle b = random.grid_triangle(3);
    if (i % 2 == 0) a[2] = a[1];
    if (i % 3 == 0) b[0] = b[2];
    if (i % 5 == 0) a[1] = a[2] = a[0];
    if (i % 7 == 0) b[2] = b[0] + 2.0 * (b[1] - b[0]);
    ASSERT_EQ(triangles_touch(a, b), oracle::squared_distance(a, b) == 0)
        << to_text(a) << "| " << to_text(b);
  }
}

TEST(TrianglesTouch, AgreesWithTheExactDistanceOfThinAndNearPairs) {
  RandomTriangles random(103);
  int touching = 0;
  for (int i = 0; i < testing::runs(3000); ++i) {
    const auto [a, b] = random.close_pair();
    const bool expected = oracle::squared_distance(a, b) == 0;
    touching += expected ? 1 : 0;
    ASSERT_EQ(triangles_touch(a, b), expected) << to_text(a) << "| " << to_text(b);
  }
  EXPECT_GT(touching, testing::runs(200));
}

TEST(TrianglesTouch, DoesNotDependOnTheOrderOfArgumentsAndVertices) {
  RandomTriangles random(104);
  for (int i = 0; i < 500; ++i) {
    const auto [a, b] = i % 2 == 0 ? random.close_pair()
                                   : std::pair(random.grid_triangle(3), random.grid_triangle(3));
    const bool expected = triangles_touch(a, b);
    for (const Triangle& pa : vertex_orders(a)) {
      for (const Triangle& pb : vertex_orders(b)) {
        ASSERT_EQ(triangles_touch(pa, pb), expected) << to_text(pa) << "| " << to_text(pb);
        ASSERT_EQ(triangles_touch(pb, pa), expected) << to_text(pa) << "| " << to_text(pb);
      }
    }
  }
}

TEST(TrianglesTouch, IsExactFarFromTheOrigin) {
  RandomTriangles random(105);
  for (int i = 0; i < testing::runs(2000); ++i) {
    // Multiples of 2^-20 are exact at 2^20, so the moved pair is the same pair.
    const Vec3 far(0x1p20, -0x1p20, 0x1p19);
    Triangle a = random.grid_triangle(3);
    Triangle b = random.grid_triangle(3);
    for (Vec3& v : b) v += 0x1p-20 * random.on_grid(2);
    ASSERT_EQ(triangles_touch(moved(a, far), moved(b, far)), triangles_touch(a, b))
        << to_text(a) << "| " << to_text(b);
  }
}

TEST(TrianglesTouch, AnswersForTheSmallestAndTheLargestNumbers) {
  RandomTriangles random(106);
  for (const double unit : {0x1p-1074, 0x1p-1000, 0x1p-500, 0x1p300, 0x1p600, 0x1p1000}) {
    for (int i = 0; i < 200; ++i) {
      Triangle a = random.grid_triangle(3);
      Triangle b = random.grid_triangle(3);
      const bool expected = triangles_touch(a, b);
      for (Vec3& v : a) v *= unit;
      for (Vec3& v : b) v *= unit;
      ASSERT_EQ(triangles_touch(a, b), expected) << to_text(a) << "| " << to_text(b);
    }
  }
}

}  // namespace
}  // namespace camway::geometry
