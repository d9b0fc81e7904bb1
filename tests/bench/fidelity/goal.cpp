// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/goal.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "daemon/correction/smoothing/objective_cost.h"
#include "tests/bench/fidelity/objective_value.h"

namespace camway::bench {

namespace {

using correction::Objective;
using motion::CubicPath;
using motion::CubicPiece;

constexpr double kSampleStep = 0.25;  // between gaps, as a share of the ball's radius
constexpr int kMostSamples = 200;     // of a piece

/// The integral of a function of the gap over the eye's curve, by the middles of equal times.
template <class Use>
double integral(const CubicPath& path, correction::FreeSpace& space, double most_m,
                const Use& use) {
  double sum = 0.0;
  for (const CubicPiece& piece : path.pieces) {
    const double length_m = eye_length_m(piece);
    const double wanted = std::ceil(length_m / (kSampleStep * space.ball_radius_m()));
    const int count = static_cast<int>(std::clamp(wanted, 1.0, double{kMostSamples}));
    double part = 0.0;
    for (int i = 0; i < count; ++i) {
      const double time_s = std::lerp(piece.t0_s, piece.t1_s, (i + 0.5) / count);
      const motion::Pose pose = motion::pose_of(path.reference, motion::point_at(piece, time_s));
      part += use(std::clamp(space.gap_m(pose, most_m), 0.0, most_m));
    }
    sum += part / count * length_m;
  }
  return sum;
}

Goal measured_goal(Objective objective, const Shot& shot) {
  return {.cost = [objective](const CubicPath& path) { return curve_cost(objective, path); },
          .may_turn = false,
          .least_height_m = shot.space().ball_radius_m()};
}

}  // namespace

Goal closeness_goal(const Shot& shot) {
  return {.cost = [&shot](const CubicPath& path) { return shot.cost(path); }};
}

std::vector<Goal> goals_of(Objective objective, const Shot& shot) {
  if (objective == Objective::kClosest) return {closeness_goal(shot)};
  if (objective != Objective::kSafest) return {measured_goal(objective, shot)};
  std::vector<Goal> goals;
  for (const double sharpness : kSharpness) goals.push_back(danger_goal(shot, sharpness));
  return goals;
}

Goal danger_goal(const Shot& shot, double sharpness) {
  collision::Query query = shot.space().query();
  query.options.clearance_m = 0.0;
  query.obstacles.bounds = {};  // a clearance is about the scene alone
  const auto space = std::make_shared<correction::FreeSpace>(query);
  const double most_m = sufficient_gap_m(shot);
  const double soft_m = kSoftShare * most_m;
  const auto cost = [=](const CubicPath& path) {
    return integral(path, *space, most_m, [&](double gap_m) {
      return std::pow((most_m + soft_m) / (gap_m + soft_m), sharpness) - 1.0;
    });
  };
  return {.cost = cost, .may_turn = false, .least_height_m = shot.space().ball_radius_m()};
}

double sufficient_gap_m(const Shot& shot) {
  return correction::kComfort * shot.space().ball_radius_m();
}

}  // namespace camway::bench
