// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/polish.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "daemon/collision/clearance.h"
#include "daemon/correction/ladder/spare_keyframes.h"
#include "daemon/correction/smoothing/objective_cost.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

namespace {

// Chosen by measurement; none changes what is proved.
constexpr int kPursuitStepsPerLeg = 40;
constexpr int kPursuitStepsOfCurve = 60;        // the same, for measures of the curve alone
constexpr int kMostStepsOfCurve = 24;           // of these, on one row
constexpr double kPursuitWorth = 0.03;          // least gain of a row, as a share of the objective
constexpr double kPursuitWorthOfLength = 0.01;  // the same of a length, most of which has to stay
constexpr double kKeptGap = 0.95;               // share of a tight gap that is kept
constexpr std::array<int, 4> kPursuitKnots = {6, 12, 24, 48};

Improvement pursuit_of(Objective objective) {
  Improvement pursuit{.objective = objective, .may_turn = false, .worth = kPursuitWorth};
  if (measures_curve(objective)) pursuit.most_steps = kMostStepsOfCurve;
  if (objective == Objective::kShortest) pursuit.worth = kPursuitWorthOfLength;
  return pursuit;
}

class Polisher {
 public:
  Polisher(const motion::TimeOrigin& origin, FreeSpace& space, CorrectedPath& corrected,
           CollisionList& collisions)
      : origin_(origin),
        space_(space),
        corrected_(corrected),
        collisions_(collisions),
        before_(corrected.path()) {}

  bool pursue(Objective objective) {
    bool gains = false;
    const Improvement pursuit = pursuit_of(objective);
    const int steps = measures_curve(objective) ? kPursuitStepsOfCurve : kPursuitStepsPerLeg;
    base::Budget budget(steps * static_cast<std::int64_t>(collisions_.count_legs()));
    const std::vector<bool> legs = collisions_.corrected_legs(corrected_);
    for (const int knots : kPursuitKnots) {
      for (std::size_t leg = 0; leg < legs.size() && !deadline().passed(); ++leg) {
        if (!legs[leg]) continue;
        const Problem part = part_about(leg);
        FreeSpace& space = measures_curve(objective) ? keeping_gap(leg) : space_;
        const std::optional<Candidate> other =
            polished(part, knots, pursuit, budget, space, deadline());
        if (other && take_if_better(leg, objective, *other, part)) gains = true;
      }
    }
    return gains;
  }

 private:
  /// The free space of a path that comes no nearer to the scene about a leg than it did before, if
  /// it came nearer than `kTightGap`.
  FreeSpace& keeping_gap(std::size_t leg) {
    std::optional<FreeSpace>& space = spaces_[leg];
    if (space) return *space;
    collision::Query query = space_.query();
    const std::size_t last = std::min(leg + 2, corrected_.keyframes_s().size() - 1);
    double kept_m = query.options.clearance_m + kTightGap * space_.ball_radius_m();
    for (std::size_t i = leg == 0 ? 0 : leg - 1; i < last; ++i) {
      kept_m = std::min(kept_m, kKeptGap * least_distance_m(i));
    }
    query.options.clearance_m = std::max(query.options.clearance_m, kept_m);
    space.emplace(query, space_.policy(), space_.closeness());
    return *space;
  }

  /// Least distance of the body from the scene between a keyframe and the next, before this
  /// polishing; 0 if the deadline strikes.
  [[nodiscard]] double least_distance_m(std::size_t leg) {
    const auto [known, is_new] = distances_m_.try_emplace(leg, 0.0);
    if (!is_new) return known->second;
    const std::vector<double>& keyframes_s = corrected_.keyframes_s();
    const motion::CubicPath part = before_.around(keyframes_s[leg], keyframes_s[leg + 1]);
    const auto clearance =
        collision::path_clearance(space_.obstacles(), part.path(), space_.body(), deadline());
    if (clearance) known->second = clearance->lower_bound_m;
    return known->second;
  }

  [[nodiscard]] Problem part_about(std::size_t leg) const {
    return collisions_.with_open_collisions(
        corrected_.part_about(leg, origin_, space_.ball_radius_m()));
  }

  [[nodiscard]] const base::Deadline& deadline() const { return corrected_.deadline(); }

  [[nodiscard]] ObjectiveCost cost(Objective objective, const motion::CubicPath& path,
                                   const Problem& part) const {
    return objective_cost(objective, path, part.original, space_, deadline());
  }

  bool take_if_better(std::size_t leg, Objective objective, const Candidate& other,
                      const Problem& part) {
    return is_better(cost(objective, other.path, part), cost(objective, part.path, part)) &&
           take(leg, other);
  }

  bool take(std::size_t leg, const Candidate& candidate) {
    if (!corrected_.take(candidate)) return false;
    const std::vector<double>& keyframes_s = corrected_.keyframes_s();
    collisions_.widen(keyframes_s[leg], keyframes_s[leg + 1], corrected_.range_of(candidate));
    return true;
  }

  const motion::TimeOrigin& origin_;
  FreeSpace& space_;
  CorrectedPath& corrected_;
  CollisionList& collisions_;
  const motion::CubicPath before_;
  std::map<std::size_t, double> distances_m_;               ///< by leg
  std::map<std::size_t, std::optional<FreeSpace>> spaces_;  ///< by leg
};

}  // namespace

bool polish(Objective objective, const motion::TimeOrigin& origin, FreeSpace& space,
            CorrectedPath& corrected, CollisionList& collisions) {
  if (objective == Objective::kClosest) return false;
  const motion::CubicPath before = corrected.path();
  const bool gains = Polisher(origin, space, corrected, collisions).pursue(objective);
  if (gains) spare_keyframes(objective, before, origin, space, corrected, collisions);
  return gains;
}

}  // namespace camway::correction
