// SPDX-License-Identifier: MIT
#include "daemon/geometry/segment_triangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "daemon/geometry/triangle_distance.h"
#include "tests/geometry/exact_oracle.h"
#include "tests/geometry/random_triangles.h"
#include "tests/support/sanitizer.h"

namespace camway::geometry {
namespace {

Triangle as_triangle(const LineSegment& s) { return {s.from, s.to, s.to}; }

Vec3 point_at(const LineSegment& s, double fraction) { return s.from + fraction * (s.to - s.from); }

TEST(HitFraction, HitsExactlyWhatTouches) {
  RandomTriangles random(401);
  int hits = 0;
  for (int i = 0; i < testing::runs(4000); ++i) {
    const LineSegment segment{random.on_grid(4), random.on_grid(4)};
    const Triangle t = random.grid_triangle(4);
    const bool expected = oracle::squared_distance(as_triangle(segment), t) == 0;
    hits += expected ? 1 : 0;
    ASSERT_EQ(hit_fraction(segment, t).has_value(), expected) << to_text(t);
  }
  EXPECT_GT(hits, testing::runs(300));
}

TEST(HitFraction, NamesAPointOfTheTriangleAndNoneBefore) {
  RandomTriangles random(402);
  for (int i = 0; i < testing::runs(4000); ++i) {
    const LineSegment segment{random.on_grid(4), random.on_grid(4)};
    const Triangle t = random.grid_triangle(4);
    const std::optional<double> fraction = hit_fraction(segment, t);
    if (!fraction) continue;
    ASSERT_GE(*fraction, 0.0);
    ASSERT_LE(*fraction, 1.0);
    const Vec3 hit = point_at(segment, *fraction);
    const double error_m = triangle_distance_error_m(as_triangle(segment), t);
    // On this grid no height is below a thirtieth of an edge.
    ASSERT_LE(oracle::distance_m({hit, hit, hit}, t), 32.0 * error_m) << to_text(t);
    if (*fraction > 0.0) {
      // The segment is clear of the triangle up to a thousandth before the hit.
      const Vec3 before = point_at(segment, *fraction * (1.0 - 1e-3));
      ASSERT_GT(oracle::squared_distance({segment.from, before, before}, t), 0) << to_text(t);
    }
  }
}

TEST(HitFraction, NothingSlipsThroughASharedEdgeOrVertex) {
  RandomTriangles random(403);
  for (int i = 0; i < testing::runs(3000); ++i) {
    // A fan of four triangles about a vertex, far from the origin, and a segment aimed at the
    // vertex or a shared edge as closely as doubles allow.
    const Vec3 center = random.in_cube(1e6);
    std::array<Vec3, 4> rim = {center + Vec3(1.0, 0.1, 0.0), center + Vec3(0.1, 1.0, 0.0),
                               center + Vec3(-1.0, 0.2, 0.0), center + Vec3(0.2, -1.0, 0.0)};
    for (Vec3& v : rim) v += random.in_cube(0.05);
    const Vec3 target = center + random.uniform(0.0, 0.5) * (rim[0] - center);
    const Vec3 direction = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 2.0);
    const LineSegment segment{target - random.uniform(0.5, 3.0) * direction,
                              target + random.uniform(0.5, 3.0) * direction};
    int hits = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      hits += hit_fraction(segment, {center, rim[k], rim[(k + 1) % 4]}) ? 1 : 0;
    }
    ASSERT_GE(hits, 1);
  }
}

TEST(HitFraction, IsMonotoneInTheOffsetAlongTheNormal) {
  const Triangle t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  for (int i = 0; i <= 8; ++i) {
    const double height = i / 8.0;
    const LineSegment segment{Vec3(0.25, 0.25, height), Vec3(0.25, 0.25, height - 1.0)};
    const std::optional<double> fraction = hit_fraction(segment, t);
    ASSERT_TRUE(fraction);
    EXPECT_NEAR(*fraction, height, triangle_distance_error_m(as_triangle(segment), t));
  }
}

TEST(HitFraction, EntersACoplanarTriangleAtItsEdge) {
  const Triangle t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const LineSegment across{Vec3(-1.0, 0.25, 0.0), Vec3(1.0, 0.25, 0.0)};
  EXPECT_EQ(hit_fraction(across, t), std::optional(0.5));
  const LineSegment along_the_edge{Vec3(-1.0, 0.0, 0.0), Vec3(1.0, 0.0, 0.0)};
  EXPECT_EQ(hit_fraction(along_the_edge, t), std::optional(0.5));
  const LineSegment inside{Vec3(0.25, 0.25, 0.0), Vec3(1.0, 1.0, 0.0)};
  EXPECT_EQ(hit_fraction(inside, t), std::optional(0.0));
  const LineSegment point{Vec3(0.25, 0.25, 0.0), Vec3(0.25, 0.25, 0.0)};
  EXPECT_EQ(hit_fraction(point, t), std::optional(0.0));
}

}  // namespace
}  // namespace camway::geometry
