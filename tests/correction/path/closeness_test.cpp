// SPDX-License-Identifier: MIT
#include "daemon/correction/path/closeness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "daemon/motion/body/body.h"
#include "daemon/motion/spline/bump.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/body_motion.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::CubicPath;
using motion::Keyframe;

// Bound on the rounding of some sums of lengths up to 20 m, an arc sine and a division.
constexpr double kAngleRounding_rad = 1e-12;

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
  EXPECT_NEAR(shift.largest_rad, 0.2 / 4.0, kAngleRounding_rad);
  // The integral of a bump is its coefficient times the spacing.
  EXPECT_NEAR(shift.mean_rad, 0.2 / motion::kBumpPeak * 1.5 / 4.0 / 20.0, 1e-6);
  EXPECT_EQ(shift_of(original, original, closeness).largest_rad, 0.0);
}

// A peak between samples counts, too: the tests of the page compare its curves with these measures.
TEST(Closeness, TheLargestShiftIsThatOfAllInstants) {
  constexpr int kInstants = 20'000;
  // A share: both miss the peak by less than a thousandth of the distance of two samples.
  constexpr double kMost = 1e-5;
  testing::Random random(7306);
  const CubicPath original = straight(20.0, 1.0);
  const Closeness closeness{.viewing_distance_m = 4.0, .turn_lever_m = 4.0};
  for (int run = 0; run < 20; ++run) {
    const motion::KnotRow knots =
        motion::KnotRow::about(10.0, random.log_uniform(0.3, 3.0), nullptr);
    motion::CubicPoint peak{random.in_cube(0.5), geometry::Vec4::Zero()};
    CubicPath path = motion::with_bumps(original, std::vector{motion::BumpRow{knots, 2, {peak}}});
    // Another bump beside it moves the peak away from the knots.
    const motion::KnotRow beside =
        motion::KnotRow::about(10.7, random.log_uniform(0.3, 3.0), nullptr);
    peak.position = random.in_cube(0.5);
    path = motion::with_bumps(path, std::vector{motion::BumpRow{beside, 2, {peak}}});
    double largest_rad = 0.0;
    for (int i = 0; i <= kInstants; ++i) {
      const double at_s = 20.0 * i / kInstants;
      largest_rad =
          std::max(largest_rad, (path.at(at_s).position - original.at(at_s).position).norm() / 4.0);
    }
    EXPECT_NEAR(shift_of(path, original, closeness).largest_rad, largest_rad, kMost * largest_rad)
        << run;
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
  EXPECT_NEAR(shift_of(turned, original, camera).largest_rad, angle_rad, kAngleRounding_rad);
  const Closeness body{.viewing_distance_m = 2.0, .turn_lever_m = 0.5};
  EXPECT_NEAR(shift_of(turned, original, body).largest_rad, 0.25 * angle_rad, kAngleRounding_rad);
}

/// Returns a path through random poses, which turn by up to a radian from one to the next.
CubicPath any_path(testing::Random& random) {
  std::vector<Keyframe> keyframes;
  Quat orientation = random.rotation();
  for (int i = 0; i < 4; ++i) {
    keyframes.push_back({static_cast<double>(i), {random.in_cube(2.0), orientation}});
    orientation =
        orientation * Quat(Eigen::AngleAxisd(random.uniform(0.0, 1.0), random.direction()));
  }
  return motion::interpolate_cubic(keyframes);
}

/// Returns `path` with two bumps that move and turn it, by up to about a radian.
CubicPath moved_and_turned(const CubicPath& path, double move_m, testing::Random& random) {
  std::vector<motion::BumpRow> rows;
  for (const double middle_s : {1.3, 1.8}) {
    const geometry::Vec3 turn = 0.12 * random.direction();
    const motion::CubicPoint peak{random.in_cube(move_m),
                                  {random.uniform(-0.12, 0.12), turn.x(), turn.y(), turn.z()}};
    rows.push_back(
        {motion::KnotRow::about(middle_s, random.uniform(0.3, 0.5), nullptr), 2, {peak}});
  }
  return motion::with_bumps(path, rows);
}

// Some corner of a cube is at least (2/3)^(1/2) of the radius away from any axis through the
// centre, and so is the one opposite. One of the two moves at least by the hypotenuse of the
// centre's move and its own turn. Turns by up to a radian are at most 1.05 times as long as their
// chords.
TEST(Closeness, ABodyShiftsNoLessThanItsPointsMoveAndLessThanTwiceThat) {
  constexpr int kInstants = 3'000;
  constexpr double kMostTimes = 1.05 * std::numbers::sqrt2 / 0.816;
  constexpr double kBetween = 1e-3;  // a share: what sampling misses
  testing::Random random(7307);
  for (int run = 0; run < 40; ++run) {
    const double side_m = random.log_uniform(0.1, 2.0);
    const motion::Body body =
        *motion::Body::make(motion::BoxShape{random.in_cube(3.0), Vec3::Constant(side_m)});
    const Closeness closeness{.viewing_distance_m = random.log_uniform(0.5, 10.0),
                              .turn_lever_m = body.center_radius_m(),
                              .center_C = body.center_C()};
    const CubicPath original = any_path(random);
    const CubicPath path = moved_and_turned(original, random.log_uniform(0.01, 1.0), random);
    double largest_m = 0.0;
    double mean_m = 0.0;
    double most_turn_rad = 0.0;
    for (int i = 0; i < kInstants; ++i) {
      const double at_s = 3.0 * (i + 0.5) / kInstants;
      const motion::Pose from = original.pose(at_s);
      const motion::Pose to = path.pose(at_s);
      const double moved_m = testing::farthest_move_m(body, from, to);
      largest_m = std::max(largest_m, moved_m);
      mean_m += moved_m / kInstants;
      most_turn_rad = std::max(most_turn_rad, from.orientation.angularDistance(to.orientation));
    }
    ASSERT_LT(most_turn_rad, 1.0);
    const Shift shift = shift_of(path, original, closeness);
    const double d_m = closeness.viewing_distance_m;
    EXPECT_GE(shift.largest_rad * d_m, (1.0 - kBetween) * largest_m) << run;
    EXPECT_LE(shift.largest_rad * d_m, kMostTimes * largest_m) << run;
    EXPECT_GE(shift.mean_rad * d_m, (1.0 - kBetween) * mean_m) << run;
    EXPECT_LE(shift.mean_rad * d_m, kMostTimes * mean_m) << run;
  }
}

// A turn about the eye swings the centre; the eye moves with a turn about the centre.
TEST(Closeness, TheMoveOfABodyIsThatOfItsCenter) {
  const double angle_rad = 0.8;
  const Closeness closeness{
      .viewing_distance_m = 2.0, .turn_lever_m = 0.25, .center_C = {0, 0, -2}};
  const CubicPath original = straight(1.0, 0.0);
  const geometry::Vec4 half_turn = {std::cos(angle_rad / 4.0), std::sin(angle_rad / 4.0), 0, 0};
  CubicPath swung = original;
  for (motion::CubicPiece& piece : swung.pieces) piece.image.fill(half_turn);
  const double chord_m = 2.0 * 2.0 * std::sin(0.5 * angle_rad);
  EXPECT_NEAR(shift_of(swung, original, closeness).largest_rad, (chord_m + 0.25 * angle_rad) / 2.0,
              kAngleRounding_rad);
  CubicPath turned = swung;
  const Quat turn(Eigen::AngleAxisd(angle_rad, Vec3::UnitX()));
  for (motion::CubicPiece& piece : turned.pieces)
    piece.position.fill(closeness.center_C - turn * closeness.center_C);
  EXPECT_NEAR(shift_of(turned, original, closeness).largest_rad, 0.25 * angle_rad / 2.0,
              kAngleRounding_rad);
}

// A turn accelerates by its lever, wherever the centre is.
TEST(Closeness, TheCostOfABodyIsItsShiftAndTheAccelerationOfItsEye) {
  testing::Random random(7308);
  for (int run = 0; run < 40; ++run) {
    Closeness body{.viewing_distance_m = random.log_uniform(0.5, 10.0),
                   .turn_lever_m = random.log_uniform(0.1, 2.0),
                   .acceleration_m_per_s2 = random.log_uniform(0.1, 3.0),
                   .center_C = random.in_cube(3.0)};
    const CubicPath original = any_path(random);
    const CubicPath path = moved_and_turned(original, random.log_uniform(0.01, 1.0), random);
    const auto gentle = [&](const Closeness& closeness) {
      const double shift = shift_of(path, original, closeness).mean_rad * 3.0;
      return closeness_cost(path, original, closeness) - shift;
    };
    const double off_the_eye = gentle(body);
    body.center_C = Vec3::Zero();
    EXPECT_NEAR(off_the_eye, gentle(body), 1e-9 * (1.0 + off_the_eye)) << run;
  }
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

/// Of an angle near 1 that is found from sines, relatively; far above an epsilon.
constexpr double kTurnRounding = 1e-12;

TEST(Closeness, TheReferenceAccelerationIsThatOfTheCurveOrOfAWideCircle) {
  EXPECT_DOUBLE_EQ(reference_acceleration_m_per_s2(straight(10.0, 2.0), 5.0), 2.0 * 2.0 / 5.0);
  // Turning on the spot moves the picture, too.
  std::vector<Keyframe> turn = {{0.0, {Vec3::Zero(), Quat::Identity()}},
                                {2.0, {Vec3::Zero(), Quat::Identity()}}};
  turn[1].pose.orientation = Quat(Eigen::AngleAxisd(1.0, Vec3::UnitY()));
  constexpr double kRate_rad_per_s = 0.5;
  constexpr double kSpeed_m_per_s = kTurningShare * 4.0 * kRate_rad_per_s;
  EXPECT_NEAR(reference_acceleration_m_per_s2(motion::interpolate_cubic(turn), 4.0),
              kSpeed_m_per_s * kSpeed_m_per_s / 4.0, kTurnRounding);
  std::vector<Keyframe> still = turn;
  still[1].pose.orientation = Quat::Identity();
  const double least = reference_acceleration_m_per_s2(motion::interpolate_cubic(still), 4.0);
  EXPECT_GT(least * least, 0.0) << "costs are divided by it";
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
