// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/knot_row.h"

#include "daemon/motion/path/bezier.h"
#include "tests/motion/random_motion.h"

namespace camway::motion {
namespace {

using test::kEpsilon;
using testing::Random;

/// Returns a B-spline by the recursion of Cox and de Boor, in long double: order 1 to 4 on the
/// knots from `first`.
long double basis(const std::array<double, 5>& knots, std::size_t first, std::size_t order,
                  long double t) {
  if (order == 1) return knots[first] <= t && t < knots[first + 1] ? 1.0L : 0.0L;
  const long double left = knots[first];
  const long double right = knots[first + order];
  const long double rising = (t - left) / (knots[first + order - 1] - left);
  const long double falling = (right - t) / (right - knots[first + 1]);
  return rising * basis(knots, first, order - 1, t) +
         falling * basis(knots, first + 1, order - 1, t);
}

std::array<double, 5> random_knots(Random& random) {
  std::array<double, 5> knots;
  knots[0] = random.uniform(-5.0, 5.0);
  for (std::size_t i = 1; i < 5; ++i) knots[i] = knots[i - 1] + random.log_uniform(0.01, 1.0);
  return knots;
}

TEST(BSplinePieces, AreTheBasisFunction) {
  Random random(3501);
  for (int round = 0; round < 500; ++round) {
    const std::array<double, 5> knots = random_knots(random);
    const auto pieces = b_spline_pieces(knots);
    for (std::size_t piece = 0; piece < 4; ++piece) {
      const double u = random.uniform(0.0, 1.0);
      const long double t =
          knots[piece] + static_cast<long double>(u) * (knots[piece + 1] - knots[piece]);
      ASSERT_NEAR(bezier::value_at(pieces[piece], u), static_cast<double>(basis(knots, 0, 4, t)),
                  16.0 * kEpsilon);
    }
  }
}

/// A bump, and a time well within one of its pieces.
struct BumpPlace {
  KnotBump bump;
  double step_s;  ///< length of the piece
  double time_s;

  /// The basis function by its definition.
  [[nodiscard]] double value(double at_s) const {
    return static_cast<double>(basis(bump.knots_s, 0, 4, at_s));
  }
};

BumpPlace random_place(Random& random) {
  const KnotBump bump(random_knots(random));
  const auto piece = static_cast<std::size_t>(random.integer(0, 3));
  const double step_s = bump.knots_s[piece + 1] - bump.knots_s[piece];
  return {bump, step_s, bump.knots_s[piece] + random.uniform(0.3, 0.7) * step_s};
}

// Within one piece, differences with steps h and 2h give the derivatives of a cubic exactly.
TEST(KnotBump, HasTheDerivativesOfTheBasisFunction) {
  Random random(3503);
  for (int round = 0; round < 500; ++round) {
    const BumpPlace place = random_place(random);
    const auto& [bump, step_s, time_s] = place;
    for (const double beyond_s : {bump.knots_s.front() - 0.1, bump.knots_s.back()}) {
      EXPECT_EQ(bump.value(beyond_s), 0.0);
      EXPECT_EQ(bump.first_derivative(beyond_s), 0.0);
      EXPECT_EQ(bump.second_derivative(beyond_s), 0.0);
    }
    const double h = 0.125 * step_s;
    const double here = place.value(time_s);
    const auto slope = [&](double d_s) {
      return (place.value(time_s + d_s) - place.value(time_s - d_s)) / (2.0 * d_s);
    };
    const double bend = place.value(time_s - 2.0 * h) - 2.0 * here + place.value(time_s + 2.0 * h);
    // Times of the differences are rounded as well, where the slope is about 1 / step at most.
    const double rounding = 64.0 * kEpsilon * (1.0 + std::abs(time_s) / step_s);
    ASSERT_NEAR(bump.value(time_s), here, 16.0 * kEpsilon);
    ASSERT_NEAR(bump.first_derivative(time_s), (4.0 * slope(h) - slope(2.0 * h)) / 3.0,
                rounding / h);
    ASSERT_NEAR(bump.second_derivative(time_s), bend / (4.0 * h * h), 64.0 * kEpsilon / (h * h));
  }
}

TEST(BSplinePieces, MeetBitForBitAndSmoothly) {
  Random random(3502);
  for (int round = 0; round < 500; ++round) {
    const std::array<double, 5> knots = random_knots(random);
    const auto pieces = b_spline_pieces(knots);
    EXPECT_EQ(pieces.front()[0], 0.0);
    EXPECT_EQ(pieces.back()[3], 0.0);
    for (std::size_t i = 0; i + 1 < 4; ++i) {
      const double before = knots[i + 1] - knots[i];
      const double after = knots[i + 2] - knots[i + 1];
      const auto& a = pieces[i];
      const auto& b = pieces[i + 1];
      ASSERT_EQ(a[3], b[0]);
      const double shorter = std::min(before, after);
      ASSERT_NEAR((a[3] - a[2]) / before, (b[1] - b[0]) / after, 8.0 * kEpsilon / shorter);
      ASSERT_NEAR((a[3] - 2.0 * a[2] + a[1]) / before / before,
                  (b[2] - 2.0 * b[1] + b[0]) / after / after, 16.0 * kEpsilon / shorter / shorter);
    }
  }
}

TEST(KnotRow, IsExactAtItsEndsAndIncreasesBeyond) {
  Random random(811);
  for (int round = 0; round < 200; ++round) {
    const double begin_s = random.uniform(-1e6, 1e6);
    const KnotRow row{begin_s, begin_s + random.log_uniform(1e-3, 1e3), random.integer(1, 64)};
    EXPECT_EQ(row.knot_s(0), row.begin_s);
    EXPECT_EQ(row.knot_s(row.count), row.end_s);
    for (int k = -4; k < row.count + 4; ++k) EXPECT_LT(row.knot_s(k), row.knot_s(k + 1));
  }
}

// Far from time 0, and with knots of another row next to its own.
TEST(KnotRow, KeepsToPlacesAndStaysInOrder) {
  Random random(3503);
  int taken = 0;
  for (int round = 0; round < 300; ++round) {
    const auto places = std::make_shared<KnotPlaces>();
    places->origin = {random.log_uniform(1.0, 4e9)};
    places->same_s = random.log_uniform(1e-9, 1.0);
    const double end_s = places->origin.nearest_s(random.uniform(0.1, 0.9));
    const KnotRow row{0.0, end_s, random.integer(1, 64), places};
    for (int i = 0; i < 20; ++i) {
      const double at_s = row.spacing_s() * random.integer(0, row.count);
      places->taken_s.push_back(places->origin.nearest_s(
          at_s + (random.chance(0.5) ? 1 : -1) * random.log_uniform(1e-9, 1e-3)));
    }
    std::ranges::sort(places->taken_s);
    ASSERT_TRUE(row.fits());
    ASSERT_EQ(row.knot_s(0), 0.0);
    ASSERT_EQ(row.knot_s(row.count), end_s);
    for (int k = -2; k <= row.count + 2; ++k) {
      const double knot_s = row.knot_s(k);
      ASSERT_LT(knot_s, row.knot_s(k + 1));
      ASSERT_EQ(places->origin.nearest_s(knot_s), knot_s);
      ASSERT_LE(std::abs(knot_s - k * row.spacing_s()), 0.2 * row.spacing_s());
      if (k == 0 || k == row.count) continue;
      const auto near = std::ranges::find_if(places->taken_s, [&](double time_s) {
        return std::abs(time_s - knot_s) < 0.9 * std::min(places->same_s, row.spacing_s() / 8.0);
      });
      if (near == places->taken_s.end()) continue;
      ++taken;
      ASSERT_TRUE(std::ranges::binary_search(places->taken_s, knot_s)) << k;
    }
  }
  EXPECT_GT(taken, 1000);
}

TEST(KnotRow, FitsWhereTimesAreFineEnough) {
  const auto places = std::make_shared<KnotPlaces>();
  places->origin = {1.76e9};
  const double resolution_s = 0x1p-22;
  EXPECT_TRUE((KnotRow{0.0, 8 * 16 * resolution_s, 8, places}.fits()));
  EXPECT_FALSE((KnotRow{0.0, 8 * 16 * resolution_s, 9, places}.fits()));
  EXPECT_TRUE((KnotRow{0.0, 1e-9, 9}.fits()));
}

TEST(KnotRow, ValuesOfBumpsAddUpToOne) {
  Random random(3504);
  for (int round = 0; round < 300; ++round) {
    const auto places = std::make_shared<KnotPlaces>();
    places->origin = {4e9};
    const KnotRow row{0.0, 0x1p-21 * random.integer(300, 100000), random.integer(1, 9), places};
    const double time_s = random.uniform(0.0, row.end_s);
    double sum = 0.0;
    for (int k = -2; k <= row.count + 2; ++k) sum += row.bump(k).value(time_s);
    ASSERT_NEAR(sum, 1.0, 16.0 * kEpsilon);
    const int knot = random.integer(0, row.count);
    for (int k = knot - 3; k <= knot + 3; ++k)
      ASSERT_NEAR(row.bump_at_knot(k, knot), row.bump(k).value(row.knot_s(knot)), 4.0 * kEpsilon);
  }
}

// The purpose of the bound: it limits the acceleration from rounding of the control points of such
// a piece, relative to that of a motion of the interval's size.
TEST(LeastPiece, CarriesAccelerations) {
  Random random(3505);
  double worst = 0.0;
  for (int round = 0; round < 2000; ++round) {
    const double interval_s = random.log_uniform(1e-3, 1e4);
    const double size_m = random.log_uniform(1.0, 1e6);
    const double travelled_m = random.log_uniform(0.1, 10.0);
    const double least_s = least_piece_s(interval_s, travelled_m, size_m);
    ASSERT_GT(least_s, 0.0);
    ASSERT_LE(least_s, interval_s);
    if (least_s == interval_s) continue;
    // A piece of a parabola with that acceleration, far from the origin, cut as bumps cut pieces.
    const double acceleration = travelled_m / interval_s / interval_s;
    const double at_m = size_m * random.uniform(0.5, 1.0);
    const std::array<double, 4> whole = {at_m, at_m,
                                         at_m + acceleration * interval_s * interval_s / 6.0,
                                         at_m + acceleration * interval_s * interval_s / 2.0};
    const double u = random.uniform(0.0, 1.0 - least_s / interval_s);
    const std::array<double, 4> cut = bezier::sub_curve(whole, u, u + least_s / interval_s);
    const double seen = 6.0 * ((cut[2] - cut[1]) - (cut[1] - cut[0])) / least_s / least_s;
    worst = std::max(worst, std::abs(seen - acceleration) / acceleration);
  }
  EXPECT_LT(worst, kAccelerationNoise);
  EXPECT_GT(worst, 0.01 * kAccelerationNoise);  // no shorter than needed by much
}

TEST(LeastPiece, IsTheIntervalWhereNothingMoves) {
  EXPECT_EQ(least_piece_s(2.0, 0.0, 1.0), 2.0);
  EXPECT_EQ(least_piece_s(2.0, 0.0, 0.0), 2.0);
}

}  // namespace
}  // namespace camway::motion
