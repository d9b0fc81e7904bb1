// SPDX-License-Identifier: MIT
#include "daemon/correction/path/closeness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "daemon/motion/spline/bump.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::CubicPath;
using motion::Keyframe;

CubicPath straight(double duration_s, double speed_m_per_s) {
  const std::vector<Keyframe> keyframes = {
      {0.0, {Vec3::Zero(), Quat::Identity()}},
      {duration_s, {{duration_s * speed_m_per_s, 0, 0}, Quat::Identity()}}};
  return motion::interpolate_cubic(keyframes);
}

/// Returns `path` with one bump of this height.
CubicPath bumped(const CubicPath& path, double middle_s, double spacing_s, double height_m) {
  const motion::CubicPoint peak{{0, height_m / motion::kBumpPeak, 0}, geometry::Vec4::Zero()};
  const motion::BumpRow row{motion::KnotRow::about(middle_s, spacing_s, nullptr), 2, {peak}};
  return motion::with_bumps(path, std::vector{row});
}

TEST(Closeness, ShiftOfABumpIsItsHeightOverTheViewingDistance) {
  const CubicPath original = straight(20.0, 1.0);
  const Closeness closeness{.viewing_distance_m = 4.0, .turn_lever_m = 4.0};
  const Shift shift = shift_of(bumped(original, 10.0, 1.5, 0.2), original, closeness);
  EXPECT_NEAR(shift.largest_rad, 0.2 / 4.0, 1e-12);
  // The integral of a bump is its coefficient times the spacing.
  EXPECT_NEAR(shift.mean_rad, 0.2 / motion::kBumpPeak * 1.5 / 4.0 / 20.0, 1e-6);
  EXPECT_EQ(shift_of(original, original, closeness).largest_rad, 0.0);
}

// A peak between samples counts, too: the tests of the page compare its curves with these measures.
TEST(Closeness, TheLargestShiftIsThatOfAllInstants) {
  constexpr int kInstants = 20'000;
  constexpr double kMost = 1e-5;  // a share: both miss the peak by less than a thousandth of a sample's distance
  testing::Random random(7306);
  const CubicPath original = straight(20.0, 1.0);
  const Closeness closeness{.viewing_distance_m = 4.0, .turn_lever_m = 4.0};
  for (int run = 0; run < 20; ++run) {
    const motion::KnotRow knots = motion::KnotRow::about(10.0, random.log_uniform(0.3, 3.0), nullptr);
    motion::CubicPoint peak{random.in_cube(0.5), geometry::Vec4::Zero()};
    CubicPath path = motion::with_bumps(original, std::vector{motion::BumpRow{knots, 2, {peak}}});
    // Another bump beside it moves the peak away from the knots.
    const motion::KnotRow beside = motion::KnotRow::about(10.7, random.log_uniform(0.3, 3.0), nullptr);
    peak.position = random.in_cube(0.5);
    path = motion::with_bumps(path, std::vector{motion::BumpRow{beside, 2, {peak}}});
    double largest_rad = 0.0;
    for (int i = 0; i <= kInstants; ++i) {
      const double at_s = 20.0 * i / kInstants;
      largest_rad = std::max(largest_rad, (path.at(at_s).position - original.at(at_s).position).norm() / 4.0);
    }
    EXPECT_NEAR(shift_of(path, original, closeness).largest_rad, largest_rad, kMost * largest_rad) << run;
  }
}

TEST(Closeness, TurnsCountByTheirAngleForCamerasAndByTheirLeverForBodies) {
  // About the view, by images: exp(n a / 4) turns by a.
  const CubicPath original = straight(1.0, 1.0);
  CubicPath turned = original;
  const double angle_rad = 0.8;
  for (motion::CubicPiece& piece : turned.pieces) {
    for (geometry::Vec4& image : piece.image) {
      image = {std::cos(angle_rad / 4.0), 0, 0, std::sin(angle_rad / 4.0)};
    }
  }
  const Closeness camera{.viewing_distance_m = 2.0, .turn_lever_m = 2.0};
  EXPECT_NEAR(shift_of(turned, original, camera).largest_rad, angle_rad, 1e-12);
  const Closeness body{.viewing_distance_m = 2.0, .turn_lever_m = 0.5};
  EXPECT_NEAR(shift_of(turned, original, body).largest_rad, 0.25 * angle_rad, 1e-12);
}

TEST(Closeness, ABumpOfTheBestSpacingCostsLeast) {
  testing::Random random(7302);
  const CubicPath original = straight(200.0, 1.0);
  for (int run = 0; run < 30; ++run) {
    const Closeness closeness{.viewing_distance_m = random.log_uniform(0.5, 10.0),
                              .turn_lever_m = 1.0,
                              .acceleration_m_per_s2 = random.log_uniform(0.1, 3.0)};
    const double height_m = random.log_uniform(0.01, 2.0);
    const auto cost = [&](double spacing_s) {
      return closeness_cost(bumped(original, 100.0, spacing_s, height_m), original, closeness);
    };
    const double best_s = closeness.best_spacing_s(height_m);
    EXPECT_LT(cost(best_s), cost(0.95 * best_s));
    EXPECT_LT(cost(best_s), cost(1.05 * best_s));
  }
}

TEST(Closeness, TheReferenceAccelerationIsThatOfTheCurveOrOfAWideCircle) {
  EXPECT_DOUBLE_EQ(reference_acceleration_m_per_s2(straight(10.0, 2.0), 5.0), 2.0 * 2.0 / 5.0);
  std::vector<Keyframe> circle;
  for (int i = 0; i <= 40; ++i) {
    const double angle_rad = 0.2 * i;
    circle.push_back({0.2 * i, {{std::cos(angle_rad), std::sin(angle_rad), 0}, Quat::Identity()}});
  }
  // Natural ends bend less, so the percentile is that of the inner part.
  EXPECT_NEAR(reference_acceleration_m_per_s2(motion::interpolate_cubic(circle), 100.0), 1.0, 0.3);
}

}  // namespace
}  // namespace camway::correction
