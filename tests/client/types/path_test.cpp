// SPDX-License-Identifier: MIT
#include <camway/path.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/random.h"

namespace camway {
namespace {

constexpr std::uint32_t kPathSeed = 20060623;
constexpr double kUnitRoundoff = std::numeric_limits<double>::epsilon() / 2;

/// Returns a bound on the error of de Casteljau's algorithm in degree n. Each of its n rounds takes
/// a convex combination (one rounding in 1-u, two products, one sum: at most 3 units relatively),
/// so the error is at most 3 n u max|p| to first order; one n more covers the higher orders.
double de_casteljau_error(int degree, double largest) {
  return 4.0 * degree * kUnitRoundoff * largest;
}

/// Returns a bound on the error from the parameter. `t` is rounded, so u is off by a few units,
/// which moves the point by |derivative| times that; the derivative of degree n is at most 2 n
/// max|p|.
double parameter_error(int degree, double largest, double largest_u_error) {
  return 2.0 * degree * largest * largest_u_error;
}

template <std::size_t Count, std::size_t Dimension>
std::array<long double, Dimension> bernstein_sum(
    const std::array<std::array<double, Dimension>, Count>& points, long double u) {
  std::array<long double, Dimension> sum{};
  long double binomial = 1;
  constexpr int kDegree = static_cast<int>(Count) - 1;
  for (int i = 0; i <= kDegree; ++i) {
    const long double weight = binomial * std::pow(u, static_cast<long double>(i)) *
                               std::pow(1 - u, static_cast<long double>(kDegree - i));
    for (std::size_t d = 0; d < Dimension; ++d) sum[d] += weight * points[std::size_t(i)][d];
    binomial = binomial * (kDegree - i) / (i + 1);
  }
  return sum;
}

class PathTest : public ::testing::Test {
 protected:
  PathTest() { RecordProperty("seed", static_cast<int>(kPathSeed)); }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// Returns a segment whose orientation is never near zero: control points around (1, 0, 0, 0).
  Segment random_segment(double t0_s, double t1_s) {
    Segment segment;
    segment.t0_s = t0_s;
    segment.t1_s = t1_s;
    for (auto& point : segment.position_m) {
      for (double& number : point) number = uniform(-10, 10);
    }
    for (auto& point : segment.orientation_wxyz) {
      point = {1.0, uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    }
    return segment;
  }

  testing::Random random_{kPathSeed};
};

TEST_F(PathTest, AgreesWithTheBernsteinSum) {
  SCOPED_TRACE(::testing::Message() << "seed " << kPathSeed);
  for (int round = 0; round < 2000; ++round) {
    const double t0 = uniform(-5, 5);
    const Segment segment = random_segment(t0, t0 + uniform(0.1, 5));
    const Path path({segment});
    const double t = uniform(segment.t0_s, segment.t1_s);
    const long double u = (static_cast<long double>(t) - segment.t0_s) /
                          (static_cast<long double>(segment.t1_s) - segment.t0_s);
    const Pose pose = path.pose(t);

    // u = (t - t0) / (t1 - t0) has three roundings of relative size kUnitRoundoff.
    const double u_error = 4.0 * kUnitRoundoff;
    const auto position = bernstein_sum(segment.position_m, u);
    const double bound = de_casteljau_error(3, 10.0) + parameter_error(3, 10.0, u_error);
    for (std::size_t d = 0; d < 3; ++d) {
      EXPECT_LE(std::abs(double(position[d] - pose.position_m[d])), bound);
    }
    auto turn = bernstein_sum(segment.orientation_wxyz, u);
    const long double length =
        std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]);
    // The numerator has a length of at least 1 (its first number is 1), so the division does not
    // enlarge its error; hypot and the division add a few units.
    const double turn_bound =
        2.0 * (de_casteljau_error(6, 1.0) + parameter_error(6, 1.0, u_error)) + 8 * kUnitRoundoff;
    for (std::size_t d = 0; d < 4; ++d) {
      EXPECT_LE(std::abs(double(turn[d] / length - pose.orientation_wxyz[d])), turn_bound);
    }
  }
}

TEST_F(PathTest, OrientationHasUnitLengthWhateverTheScale) {
  for (const double scale : {1e-200, 1.0, 1e200}) {
    Segment segment = random_segment(0, 1);
    for (auto& point : segment.orientation_wxyz) {
      for (double& number : point) number *= scale;
    }
    for (int i = 0; i <= 100; ++i) {
      const auto q = Path({segment}).pose(i / 100.0).orientation_wxyz;
      const double squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
      // Each number has an error of at most 4 units (three hypot, one division), the sum of squares
      // 8 and a few.
      EXPECT_NEAR(squared, 1.0, 16 * kUnitRoundoff) << "scale " << scale;
    }
  }
}

TEST_F(PathTest, EndsAreControlPointsAndTimesOutsideStayThere) {
  std::vector<Segment> segments{random_segment(1, 2), random_segment(2, 2.5),
                                random_segment(2.5, 4)};
  const Path path(segments);
  EXPECT_EQ(path.begin(), 1.0);
  EXPECT_EQ(path.end(), 4.0);
  EXPECT_EQ(path.pose(1.0).position_m, segments[0].position_m[0]);
  EXPECT_EQ(path.pose(4.0).position_m, segments[2].position_m[3]);
  EXPECT_EQ(path.pose(-1e300).position_m, segments[0].position_m[0]);
  EXPECT_EQ(path.pose(std::numeric_limits<double>::infinity()).position_m,
            segments[2].position_m[3]);
  // At a join the later segment is evaluated.
  EXPECT_EQ(path.pose(2.0).position_m, segments[1].position_m[0]);
  EXPECT_EQ(path.pose(2.5).position_m, segments[2].position_m[0]);
}

TEST_F(PathTest, FindsTheSegmentAmongMany) {
  std::vector<Segment> segments;
  for (int i = 0; i < 1000; ++i) {
    Segment segment = random_segment(i, i + 1);
    for (auto& point : segment.position_m) point = {double(i), 0, 0};
    segments.push_back(segment);
  }
  const Path path(segments);
  for (int round = 0; round < 2000; ++round) {
    const double t = uniform(0, 1000);
    // De Casteljau on equal points returns them up to rounding.
    EXPECT_NEAR(path.pose(t).position_m[0], std::floor(t), de_casteljau_error(3, 1000.0));
  }
}

TEST_F(PathTest, GivesNaNWhereThereIsNoPose) {
  EXPECT_TRUE(std::isnan(Path().pose(0).position_m[0]));
  EXPECT_EQ(Path().begin(), 0.0);
  EXPECT_TRUE(Path().empty());
  Segment segment = random_segment(0, 1);
  EXPECT_TRUE(
      std::isnan(Path({segment}).pose(std::numeric_limits<double>::quiet_NaN()).position_m[0]));
  for (auto& point : segment.orientation_wxyz) point = {0, 0, 0, 0};
  EXPECT_TRUE(std::isnan(Path({segment}).pose(0.5).orientation_wxyz[0]));
  EXPECT_FALSE(std::isnan(Path({segment}).pose(0.5).position_m[0]));
}

}  // namespace
}  // namespace camway
