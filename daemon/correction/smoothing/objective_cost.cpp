// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/objective_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/collision/clearance.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using motion::CubicPiece;

constexpr int kSamplesAPiece = 16;
constexpr double kSampleStep = 0.25;  // step between samples, as a share of the ball's radius
constexpr double kFewestSamples = 32.0;
constexpr double kMostSamples = 2000.0;
constexpr double kWorthAChange = 1e-3;  // share of the cost: less is within the error of samples

template <class Use>
void for_each_sample(const motion::CubicPath& path, const Use& use) {
  for (const CubicPiece& piece : path.pieces) {
    for (int i = 0; i <= kSamplesAPiece; ++i)
      use(std::lerp(piece.t0_s, piece.t1_s, static_cast<double>(i) / kSamplesAPiece));
  }
}

double length_m(const motion::CubicPath& path) {
  double length_m = 0.0;
  Vec3 last = path.pieces.front().position.front();
  for_each_sample(path, [&](double time_s) {
    const Vec3 here = path.at(time_s).position;
    length_m += (here - last).norm();
    last = here;
  });
  return length_m;
}

// The acceleration of a cubic is linear in time.
double bending_energy(const CubicPiece& piece) {
  const double duration_s = piece.t1_s - piece.t0_s;
  const auto acceleration = [&](std::size_t i) -> Vec3 {
    const Vec3 bend = piece.position[i] - 2.0 * piece.position[i + 1] + piece.position[i + 2];
    return 6.0 / (duration_s * duration_s) * bend;
  };
  const Vec3 begin = acceleration(0);
  const Vec3 end = acceleration(1);
  return duration_s / 3.0 * (begin.squaredNorm() + begin.dot(end) + end.squaredNorm());
}

/// Calls `use(gap, way)` with the gap, at most `up_to_m`, and the eye's distance from the last
/// sample.
template <class Use>
void for_each_gap(const motion::CubicPath& path, double step_m, double up_to_m, FreeSpace& space,
                  const Use& use) {
  const double samples = length_m(path) / step_m;
  const int steps = static_cast<int>(std::clamp(samples, kFewestSamples, kMostSamples));
  Vec3 last = path.pieces.front().position.front();
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const motion::Pose pose = path.pose(std::lerp(path.begin_s(), path.end_s(), share));
    use(space.gap_m(pose, up_to_m), (pose.position - last).norm());
    last = pose.position;
  }
}

// Integrates over the curve's length and not over time: otherwise lingering in a safe place would
// lower the cost of danger elsewhere.
double danger(const motion::CubicPath& path, FreeSpace& space) {
  const double comfort_m = kComfort * space.ball_radius_m();
  double danger_m = 0.0;
  for_each_gap(path, kSampleStep * space.ball_radius_m(), comfort_m, space,
               [&](double gap_m, double way_m) {
                 const double missing = 1.0 - std::clamp(gap_m / comfort_m, 0.0, 1.0);
                 danger_m += missing * missing * way_m;
               });
  return danger_m;
}

}  // namespace

double bending_energy(const motion::CubicPath& path) {
  double sum = 0.0;
  for (const CubicPiece& piece : path.pieces) sum += bending_energy(piece);
  return sum;
}

double objective_value(Objective objective, const motion::CubicPath& path,
                       const motion::CubicPath& original, FreeSpace& space) {
  switch (objective) {
    case Objective::kClosest:
      return closeness_cost(path, original, space.closeness());
    case Objective::kShortest:
      return length_m(path);
    case Objective::kSmoothest:
      return bending_energy(path);
    case Objective::kSafest:
      break;
  }
  return danger(path, space);
}

ObjectiveCost objective_cost(Objective objective, const motion::CubicPath& path,
                             const motion::CubicPath& original, FreeSpace& space,
                             const base::Deadline& deadline) {
  ObjectiveCost cost{objective_value(objective, path, original, space), 0.0};
  if (objective != Objective::kSafest) return cost;
  // Answers report this bound, which does not depend on samples.
  const auto clearance =
      collision::path_clearance(space.obstacles(), path.path(), space.body(), deadline);
  if (!clearance) return {std::numeric_limits<double>::infinity(), 0.0};
  const double gap_m = clearance->lower_bound_m - space.query().options.clearance_m;
  cost.least_gap_m = std::clamp(gap_m, 0.0, kComfort * space.ball_radius_m());
  return cost;
}

bool is_better(const ObjectiveCost& now, const ObjectiveCost& before) {
  return now.value < (1.0 - kWorthAChange) * before.value && now.least_gap_m >= before.least_gap_m;
}

}  // namespace camway::correction
