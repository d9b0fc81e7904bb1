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

/// The free space of paths that come no nearer to the scene than `least_m`, as far as the objective
/// asks for more than the required clearance.
FreeSpace keeping_gap(Objective objective, double least_m, const FreeSpace& space) {
  const double radii = measures_curve(objective) ? kTightGap : kComfort;
  collision::Query query = space.query();
  const double most_m = query.options.clearance_m + radii * space.ball_radius_m();
  query.options.clearance_m = std::max(query.options.clearance_m, std::min(least_m, most_m));
  return FreeSpace(query, space.policy(), space.closeness());
}

/// A part of a path that was improved for an objective.
struct ImprovedPart {
  const Problem& problem;
  const ChangedPart& part;
  const CubicPath& path;
  const CubicPath& before;  ///< the path before it was improved
};

/// Returns the part on fewer knots, with a distance of at least `least_m` from the scene; nothing
/// if none can be spared.
std::optional<Candidate> sparser(const ImprovedPart& improved, Objective objective, double least_m,
                                 FreeSpace& space, const base::Deadline& deadline) {
  const auto& [problem, part, path, before] = improved;
  FreeSpace keeping = keeping_gap(objective, least_m, space);
  PartDrawer drawer(problem, part, part, objective, keeping, space, deadline);
  const double cost = drawer.cost(path);
  const double cost_before = drawer.cost(before);
  if (cost_before <= cost) return std::nullopt;
  std::optional<Drawing> best = drawer.drawing(drawer.choice().knots_of(path), path);
  if (!best) return std::nullopt;
  const std::size_t knots = best->knots_s.size();
  drawer.limit_cost(most_cost(objective, cost, cost_before));
  drawer.thin_out(*best);
  if (best->knots_s.size() >= knots) return std::nullopt;
  return std::move(best->drawn.candidate);
}

/// The same with nearly all of the distance that the part has now. The upper bound of that distance
/// is nearer to it as a rule, but only the lower one is certain.
std::optional<Candidate> sparser(const ImprovedPart& improved, Objective objective,
                                 FreeSpace& space, const base::Deadline& deadline) {
  const CubicPath part = improved.path.around(improved.part.begin_s, improved.part.end_s);
  const auto now =
      collision::path_clearance(space.obstacles(), part.path(), space.body(), deadline);
  if (!now) return std::nullopt;
  for (const double bound_m : {now->upper_bound_m, now->lower_bound_m}) {
    std::optional<Candidate> found =
        sparser(improved, objective, kSparseGap * bound_m, space, deadline);
    if (found) return found;
  }
  return std::nullopt;
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
        sparser({problem, part, path, before}, objective, space, corrected.deadline());
    if (drawn && corrected.take_instead(part, *drawn)) {
      collisions.set_range(part, corrected.range_of(*drawn));
    }
  }
}

}  // namespace camway::correction
