// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/cubic_spline.h"

#include "daemon/motion/path/bezier.h"
#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using test::kEpsilon;
using test::Vec3;
using test::Vec4;
using testing::Random;

std::vector<double> random_knots(Random& random, int count) {
  std::vector<double> knots = {random.normal()};
  for (int i = 1; i < count; ++i) knots.push_back(knots.back() + random.log_uniform(0.02, 1.0));
  return knots;
}

/// Returns the largest distance of the spline from `curve`, relative to the size of the data.
template <class Curve>
double error_of_spline(const std::vector<double>& knots, EndCondition ends, Curve curve) {
  std::vector<Vec4> points;
  double size = 0.0;
  for (const double knot : knots) {
    points.push_back(curve(knot));
    size = std::max(size, points.back().norm());
  }
  const std::vector<Vec4> slopes = spline_slopes<Vec4>(knots, points, ends);
  double error = 0.0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const std::array<Vec4, 4> piece = spline_piece<Vec4>(knots, points, slopes, i);
    for (int k = 0; k <= 4; ++k) {
      const double u = k / 4.0;
      const Vec4 expected = curve(bezier::lerp(knots[i], knots[i + 1], u));
      error = std::max(error, (bezier::value_at(piece, u) - expected).norm());
    }
  }
  return error / size;
}

// Differences of nearby points lose digits in proportion to the shortness of an interval.
constexpr double kReproduced = 1e-12;

TEST(CubicSpline, ReproducesLines) {
  Random random(71);
  const std::vector<double> knots = random_knots(random, 30);
  const Vec4 a = geometry::wxyz(random.rotation());
  const Vec4 b = geometry::wxyz(random.rotation());
  const auto line = [&](double t) { return Vec4(a + t * b); };
  EXPECT_LT(error_of_spline(knots, EndCondition::kNatural, line), kReproduced);
  EXPECT_LT(error_of_spline(knots, EndCondition::kBessel, line), kReproduced);
}

TEST(CubicSpline, ReproducesParabolasWithBesselEndsOnly) {
  Random random(72);
  for (const int count : {3, 4, 30}) {
    const std::vector<double> knots = random_knots(random, count);
    const Vec4 a = geometry::wxyz(random.rotation());
    const Vec4 b = geometry::wxyz(random.rotation());
    const auto parabola = [&](double t) { return Vec4(a + t * t * b); };
    EXPECT_LT(error_of_spline(knots, EndCondition::kBessel, parabola), kReproduced);
    EXPECT_GT(error_of_spline(knots, EndCondition::kNatural, parabola), 1e-6);
  }
}

// Away from the ends the error of cubic spline interpolation is of fourth order: half of the
// spacing gives 1/16 of the error. At natural ends it is of second order.
TEST(CubicSpline, ConvergesWithTheOrderOfItsEnds) {
  const auto wave = [](double t) { return Vec4(std::sin(t), std::cos(2.0 * t), t, std::exp(-t)); };
  const auto error = [&](int count, EndCondition ends) {
    std::vector<double> knots;
    for (int i = 0; i < count; ++i) knots.push_back(3.0 * i / (count - 1));
    return error_of_spline(knots, ends, wave);
  };
  const double natural = error(321, EndCondition::kNatural) / error(641, EndCondition::kNatural);
  const double bessel = error(321, EndCondition::kBessel) / error(641, EndCondition::kBessel);
  EXPECT_NEAR(natural, 4.0, 0.4);
  EXPECT_NEAR(bessel, 8.0, 0.8);
}

TEST(CubicSpline, SecondDerivativesAgreeAtKnots) {
  Random random(73);
  for (const EndCondition ends : {EndCondition::kNatural, EndCondition::kBessel}) {
    const std::vector<double> knots = random_knots(random, 200);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < knots.size(); ++i) points.push_back(random.normal_vector(1.0));
    const std::vector<Vec3> slopes = spline_slopes<Vec3>(knots, points, ends);
    for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
      const double before_s = knots[i] - knots[i - 1];
      const double after_s = knots[i + 1] - knots[i];
      const Vec3 left =
          bezier::jet_at(spline_piece<Vec3>(knots, points, slopes, i - 1), 1.0).second;
      const Vec3 right = bezier::jet_at(spline_piece<Vec3>(knots, points, slopes, i), 0.0).second;
      // The rounding of stored control points, as large as the slopes make them.
      const double size = 1.0 + points[i].norm() + slopes[i].norm() * std::max(before_s, after_s);
      const double shortest_s = std::min(before_s, after_s);
      EXPECT_LT((left / (before_s * before_s) - right / (after_s * after_s)).norm(),
                100.0 * kEpsilon * size / (shortest_s * shortest_s));
    }
  }
}

}  // namespace
}  // namespace camway::motion
