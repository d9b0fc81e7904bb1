// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/objective_value.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "daemon/motion/spline/bump.h"
#include "tests/bench/fidelity/goal.h"
#include "tests/bench/fidelity/test_shots.h"

namespace camway::bench {
namespace {

using correction::Objective;
using motion::CubicPath;
using testing::Random;

/// The same curve, divided at other times.
CubicPath divided(const CubicPath& path) {
  const motion::BumpRow none{motion::KnotRow(path.begin_s(), path.end_s(), 37), 2,
                             std::vector<motion::CubicPoint>(33)};
  return motion::with_bumps(path, std::span(&none, 1));
}

/// A flight over the floor of `scene_of`, of which every instant has the same distance from it.
std::vector<motion::Keyframe> level_flight(Random& random, double height_m) {
  std::vector<motion::Keyframe> keyframes = curved_flight(random);
  for (motion::Keyframe& keyframe : keyframes) {
    keyframe.pose.position.y() = -5.0 + height_m;
    keyframe.pose.orientation = geometry::Quat::Identity();
  }
  return keyframes;
}

double half_height_m(const motion::Camera& camera) {
  return camera.near_m * std::tan(0.5 * camera.fov_y_rad);
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
    const double height_m = random.uniform(0.1, 0.3);
    const BenchRequest request = request_of(level_flight(random, height_m));
    const Shot shot(*scene, request, 1.0);
    const double half_m = half_height_m(request.camera);
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

TEST(Goal, DangerIsThatOfTheGapTimesTheLength) {
  // A share: gaps have the rounding of distances, which the largest power makes sixteen times.
  constexpr double kGapError = 1e-6;
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  Random random(5);
  for (const double height_m : {0.12, 0.16, 0.2, 0.24, 2.0}) {
    const BenchRequest request = request_of(level_flight(random, height_m));
    const Shot shot(*scene, request, 1.0);
    const double most_m = sufficient_gap_m(shot);
    const double soft_m = kSoftShare * most_m;
    const double gap_m = std::min(most_m, height_m - half_height_m(request.camera));
    const double length_m = curve_cost(Objective::kShortest, shot.interpolated());
    for (const double sharpness : kSharpness) {
      const double danger = std::pow((most_m + soft_m) / (gap_m + soft_m), sharpness) - 1.0;
      EXPECT_NEAR(danger_goal(shot, sharpness).cost(shot.interpolated()), length_m * danger,
                  kGapError * length_m * danger);
    }
  }
}

}  // namespace
}  // namespace camway::bench
