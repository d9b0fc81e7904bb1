// SPDX-License-Identifier: MIT
#include "daemon/geometry/exact_points.h"

#include "daemon/geometry/rounding.h"
#include "tests/geometry/point_sets.h"

namespace camway::geometry {
namespace {

using test::exact;
using test::exact_volume;
using test::PointSet;
using test::Rational;
using testing::Random;

std::vector<PointSet> all_sets(Random& random) {
  std::vector<PointSet> sets = test::solid_point_sets(random);
  for (PointSet& set : test::flat_point_sets(random)) sets.push_back(std::move(set));
  return sets;
}

TEST(ExactPoints, TellTheSideAsRationalNumbersDo) {
  Random random(101);
  int in_plane = 0;
  for (const PointSet& set : all_sets(random)) {
    SCOPED_TRACE(set.what);
    const ExactPoints points(set.points);
    const auto any = [&] {
      return static_cast<std::size_t>(random.integer(0, static_cast<int>(points.size()) - 1));
    };
    for (int i = 0; i < 120; ++i) {
      const std::size_t a = any(), b = any(), c = any(), d = any();
      const int expected = exact_volume(points[a], points[b], points[c], points[d]).sign();
      ASSERT_EQ(points.side(a, b, c, d), expected);
      ASSERT_EQ(points.side(b, a, c, d), -expected);
      if (expected == 0) ++in_plane;
    }
  }
  EXPECT_GT(in_plane, 300) << "the sets are too easy";
}

TEST(ExactPoints, TellLinesAndTurnsAsRationalNumbersDo) {
  Random random(102);
  int on_line = 0;
  for (const PointSet& set : all_sets(random)) {
    SCOPED_TRACE(set.what);
    const ExactPoints points(set.points);
    const auto any = [&] {
      return static_cast<std::size_t>(random.integer(0, static_cast<int>(points.size()) - 1));
    };
    for (int i = 0; i < 80; ++i) {
      const std::size_t a = any(), b = any(), c = any();
      const test::RationalVec from = exact(points[a]);
      const test::RationalVec normal = cross(exact(points[b]) - from, exact(points[c]) - from);
      const bool expected = normal[0].is_zero() && normal[1].is_zero() && normal[2].is_zero();
      ASSERT_EQ(points.collinear(a, b, c), expected);
      for (std::size_t axis = 0; axis < 3; ++axis)
        ASSERT_EQ(points.turn(a, b, c, axis), normal[axis].sign());
      if (expected) ++on_line;
    }
  }
  EXPECT_GT(on_line, 100) << "the sets are too easy";
}

TEST(ExactPoints, NormalsAreTrueHoweverThinTheTriangle) {
  Random random(103);
  // 2^-51 for each coordinate, plus the error of the length.
  constexpr double kBound = 8.0 * geometry::kUnitRoundoff;
  for (int i = 0; i < 500; ++i) {
    const Vec3 a = random.normal_vector(1.0);
    const Vec3 along = random.normal_vector(1.0);
    const std::array<Vec3, 3> given{
        a, a + along, a + 0.5 * along + random.normal_vector(random.log_uniform(1e-15, 1.0))};
    const ExactPoints points(given);
    if (points.collinear(0, 1, 2)) continue;
    const Vec3 normal = points.unit_normal(0, 1, 2);
    EXPECT_NEAR(normal.norm(), 1.0, kBound);
    // The exact normal, scaled to the range of doubles.
    const test::RationalVec from = exact(given[0]);
    const test::RationalVec n = cross(exact(given[1]) - from, exact(given[2]) - from);
    const Rational largest = std::max({abs(n[0]), abs(n[1]), abs(n[2])});
    const Vec3 expected = Vec3(Rational(n[0] / largest).convert_to<double>(),
                               Rational(n[1] / largest).convert_to<double>(),
                               Rational(n[2] / largest).convert_to<double>())
                              .normalized();
    EXPECT_LE((normal - expected).lpNorm<Eigen::Infinity>(), kBound);
  }
}

}  // namespace
}  // namespace camway::geometry
