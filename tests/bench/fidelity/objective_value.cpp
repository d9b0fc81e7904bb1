// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/objective_value.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "daemon/collision/clearance.h"
#include "daemon/collision/detect.h"
#include "daemon/correction/smoothing/objective_cost.h"
#include "tests/bench/fidelity/goal.h"

namespace camway::bench {

namespace {

using correction::Objective;
using motion::CubicPath;
using motion::CubicPiece;

/// Nodes in [0, 1] and weights of the rule of Gauss and Legendre with five nodes.
constexpr std::array<std::pair<double, double>, 5> kNodes{{
    {0.046910077030668, 0.118463442528095},
    {0.230765344947158, 0.239314335249683},
    {0.5, 0.284444444444444},
    {0.769234655052842, 0.239314335249683},
    {0.953089922969332, 0.118463442528095},
}};

bool is_proved(const collision::Query& query, const CubicPath& part) {
  const auto found = collision::detect_collisions(query, part.path(), part.begin_s(), part.end_s(),
                                                  base::Deadline::never());
  return found && found->empty();
}

}  // namespace

double eye_length_m(const CubicPiece& piece) {
  double sum = 0.0;
  for (const auto& [u, weight] : kNodes) {
    geometry::Vec3 derivative = geometry::Vec3::Zero();  // by u
    const std::array<double, 3> bernstein{(1.0 - u) * (1.0 - u), 2.0 * u * (1.0 - u), u * u};
    for (std::size_t i = 0; i < bernstein.size(); ++i) {
      derivative += 3.0 * bernstein[i] * (piece.position[i + 1] - piece.position[i]);
    }
    sum += weight * derivative.norm();
  }
  return sum;
}

double curve_cost(Objective objective, const CubicPath& path) {
  if (objective == Objective::kSmoothest) return correction::bending_energy(path);
  double sum_m = 0.0;
  for (const CubicPiece& piece : path.pieces) sum_m += eye_length_m(piece);
  return sum_m;
}

double value_of(Objective objective, const Shot& shot, const CubicPath& path,
                std::span<const TimeRange> ranges) {
  if (objective == Objective::kSafest) return proved_clearance_m(shot, path, ranges);
  double sum = 0.0;
  for (const TimeRange& range : ranges) {
    sum += curve_cost(objective, path.around(range.begin_s, range.end_s));
  }
  return sum;
}

double proved_clearance_m(const Shot& shot, const CubicPath& path,
                          std::span<const TimeRange> ranges) {
  collision::Query query = shot.space().query();
  query.obstacles.bounds = {};
  double least_m = sufficient_gap_m(shot);
  for (const TimeRange& range : ranges) {
    const CubicPath part = path.around(range.begin_s, range.end_s);
    const auto clearance = collision::path_clearance(query.obstacles, part.path(), query.body,
                                                     base::Deadline::never());
    double proved_m = std::min(least_m, clearance->lower_bound_m);
    double most_m = std::min(least_m, clearance->upper_bound_m);
    while (most_m - proved_m > kClearanceError * most_m) {
      query.options.clearance_m = 0.5 * (proved_m + most_m);
      (is_proved(query, part) ? proved_m : most_m) = query.options.clearance_m;
    }
    least_m = proved_m;
  }
  return least_m;
}

}  // namespace camway::bench
