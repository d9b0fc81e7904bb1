// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/spare_keyframes.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/collision/clearance.h"
#include "daemon/correction/ladder/part_drawer.h"
#include "daemon/correction/smoothing/objective_cost.h"

namespace camway::correction {

namespace {

using motion::CubicPath;

// Chosen by measurement; none changes what is proved.
constexpr double kMostGivenBack = 0.1;         // share of what was gained
constexpr double kSparseGrowthOfCurve = 0.02;  // of a measure of the curve alone
constexpr double kSparseGap = 0.995;           // share of the least distance that is kept

/// The largest value of the objective that is accepted for fewer keyframes.
double most_cost(Objective objective, double cost, double cost_before) {
  const double growth = kMostGivenBack * (cost_before - cost);
  if (!measures_curve(objective)) return cost + growth;
  return cost + std::min(growth, kSparseGrowthOfCurve * cost);
}

/// The free space of paths that come hardly nearer to the scene than `part` does.
FreeSpace keeping_gap(Objective objective, const CubicPath& part, const FreeSpace& space,
                      const base::Deadline& deadline) {
  const double radii = measures_curve(objective) ? kTightGap : kComfort;
  const auto clearance =
      collision::path_clearance(space.obstacles(), part.path(), space.body(), deadline);
  const double least_m = clearance ? kSparseGap * clearance->lower_bound_m : 0.0;
  collision::Query query = space.query();
  query.options.clearance_m =
      std::max(query.options.clearance_m, std::min(least_m, radii * space.ball_radius_m()));
  return FreeSpace(query, space.policy(), space.closeness());
}

/// Returns `part` of `path` on fewer knots; nothing if none can be spared.
std::optional<Candidate> sparser(const Problem& problem, const ChangedPart& part,
                                 const CubicPath& path, const CubicPath& before,
                                 Objective objective, FreeSpace& space,
                                 const base::Deadline& deadline) {
  FreeSpace keeping =
      keeping_gap(objective, path.around(part.begin_s, part.end_s), space, deadline);
  PartDrawer drawer(problem, part, part, objective, keeping, space, deadline);
  const double cost = drawer.cost(path);
  const double cost_before = drawer.cost(before);
  if (cost_before <= cost) return std::nullopt;
  std::optional<Drawing> best = drawer.drawing(drawer.choice().joints_of(path), path);
  if (!best) return std::nullopt;
  const std::size_t knots = best->knots_s.size();
  drawer.limit_cost(most_cost(objective, cost, cost_before));
  drawer.thin_out(*best);
  if (best->knots_s.size() >= knots) return std::nullopt;
  return std::move(best->drawn.candidate);
}

}  // namespace

void spare_keyframes(Objective objective, const CubicPath& before, const motion::TimeOrigin& origin,
                     FreeSpace& space, CorrectedPath& corrected, CollisionList& collisions) {
  const std::vector<ChangedPart> parts = corrected.changed_parts();
  for (const ChangedPart& part : parts) {
    if (corrected.deadline().passed()) return;
    const Problem problem =
        collisions.with_open_collisions(corrected.restored(part, origin, space.ball_radius_m()));
    const CubicPath path = corrected.path().around(problem.path.begin_s(), problem.path.end_s());
    const std::optional<Candidate> drawn =
        sparser(problem, part, path, before, objective, space, corrected.deadline());
    if (drawn && corrected.take_instead(part, *drawn)) {
      collisions.set_range(part, corrected.range_of(*drawn));
    }
  }
}

}  // namespace camway::correction
