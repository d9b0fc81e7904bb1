// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/objective_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>

#include "daemon/motion/spline/bump.h"
#include "tests/bench/fidelity/goal.h"
#include "tests/bench/fidelity/test_shots.h"

namespace camway::bench {
namespace {

using correction::Objective;
using geometry::Vec3;
using motion::CubicPath;
using testing::Random;

/// The same curve, divided at other times.
CubicPath divided(const CubicPath& path) {
  const motion::BumpRow none{motion::KnotRow(path.begin_s(), path.end_s(), 37), 2,
                             std::vector<motion::CubicPoint>(33)};
  return motion::with_bumps(path, std::span(&none, 1));
}

TEST(ObjectiveValue, DoesNotDependOnHowACurveIsDivided) {
  Random random(1);
  for (int i = 0; i < 10; ++i) {
    const CubicPath path = motion::interpolate_cubic(curved_flight(random));
    const CubicPath other = divided(path);
    ASSERT_GT(other.pieces.size(), path.pieces.size());
    for (const Objective objective : {Objective::kShortest, Objective::kSmoothest}) {
      const double value = curve_cost(objective, path);
      EXPECT_NEAR(curve_cost(objective, other), value, 1e-4 * value);
    }
  }
}

TEST(ObjectiveValue, IsTheLengthOfAFinePolyline) {
  Random random(2);
  for (int i = 0; i < 10; ++i) {
    const CubicPath path = motion::interpolate_cubic(curved_flight(random));
    constexpr int kSteps = 20'000;
    double length_m = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const double step_s = path.end_s() / kSteps;
      length_m += (path.at((k + 1) * step_s).position - path.at(k * step_s).position).norm();
    }
    EXPECT_NEAR(curve_cost(Objective::kShortest, path), length_m, 1e-5 * length_m);
  }
}

TEST(ObjectiveValue, ProvesTheClearanceOfAFloor) {
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  Random random(3);
  for (int i = 0; i < 10; ++i) {
    // The flight is level, so every instant has the same distance from the floor.
    std::vector<motion::Keyframe> keyframes = curved_flight(random);
    const double height_m = random.uniform(0.1, 0.3);
    for (motion::Keyframe& keyframe : keyframes) {
      keyframe.pose = {{keyframe.pose.position.x(), -5.0 + height_m, keyframe.pose.position.z()},
                       geometry::Quat::Identity()};
    }
    const BenchRequest request = request_of(keyframes);
    const Shot shot(*scene, request, 1.0);
    const double half_m = request.camera.near_m * std::tan(0.5 * request.camera.fov_y_rad);
    const TimeRange all{0.0, 10.0};
    const double clearance_m = proved_clearance_m(shot, shot.interpolated(), std::span(&all, 1));
    EXPECT_LE(clearance_m, height_m - half_m + 1e-9);
    EXPECT_GE(clearance_m, (1.0 - 2.0 * kClearanceError) * (height_m - half_m) - 1e-6);
  }
}

TEST(Goal, CostsOfPartsAddUp) {
  Random random(4);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(true);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 1.0);
  const CubicPath path = divided(shot.interpolated());
  for (const Objective objective :
       {Objective::kClosest, Objective::kShortest, Objective::kSmoothest, Objective::kSafest}) {
    for (const Goal& goal : goals_of(objective, shot)) {
      const double middle_s = path.pieces[path.pieces.size() / 2].t0_s;
      const double parts = goal.cost(path.around(path.begin_s(), middle_s)) +
                           goal.cost(path.around(middle_s, path.end_s()));
      EXPECT_NEAR(parts, goal.cost(path), 1e-9 * parts);
    }
  }
}

TEST(Goal, DangerFallsWithTheGapAndEndsWhereThatSuffices) {
  Random random(5);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 1.0);
  for (const double sharpness : kSharpness) {
    const Goal goal = danger_goal(shot, sharpness);
    double last = std::numeric_limits<double>::infinity();
    for (const double height_m : {0.12, 0.16, 0.2, 0.24}) {
      CubicPath path = shot.interpolated();
      for (motion::CubicPiece& piece : path.pieces) {
        for (Vec3& point : piece.position) point.y() = -5.0 + height_m;
      }
      EXPECT_LT(goal.cost(path), last);
      last = goal.cost(path);
    }
    EXPECT_EQ(goal.cost(shot.interpolated()), 0.0);  // six metres above the floor
  }
}

}  // namespace
}  // namespace camway::bench
