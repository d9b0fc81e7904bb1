// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/polish.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "daemon/correction/smoothing/objective_cost.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

namespace {

using motion::CubicPath;

// Chosen by measurement; none changes what is proved.
constexpr int kRounds = 2;
constexpr int kPolishedKnots = 12;
constexpr double kFarFromReference = 3.0;  // distance from the interpolated path, in radii
constexpr double kPullSpread = 0.25;
constexpr int kPullKnots = 16;
constexpr int kPullSteps = 24;        // for the whole path
constexpr double kMostBending = 1.5;  // largest growth of bending energy for coming closer
constexpr int kPursuitStepsPerLeg = 40;
constexpr double kPursuitWorth = 0.03;
constexpr std::array<int, 3> kPursuitKnots = {12, 24, 48};

class Polisher {
 public:
  Polisher(const motion::TimeOrigin& origin, FreeSpace& space, CorrectedPath& corrected,
           CollisionList& collisions)
      : origin_(origin), space_(space), corrected_(corrected), collisions_(collisions) {}

  void relax(base::Budget& budget) {
    std::vector<bool> needs_polish = collisions_.corrected_legs(corrected_);
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t leg = 0; leg < needs_polish.size() && !deadline().passed(); ++leg) {
        if (!needs_polish[leg]) continue;
        const std::optional<Candidate> better =
            polished(part_about(leg), kPolishedKnots, {}, budget, space_, deadline());
        if (better && take(leg, *better)) {
          for (const motion::BumpRow& row : better->rows) {
            corrected_.mark_legs(row.begin_s(), row.end_s(), needs_polish);
          }
        }
        needs_polish[leg] = false;
      }
    }
  }

  // Relaxation of detours favours smoothness, so some intervals end far away.
  void pull_to_interpolated() {
    const Improvement pull{.spread = kPullSpread};
    base::Budget budget(kPullSteps);
    for (const std::size_t leg : far_legs()) {
      if (deadline().passed()) continue;
      const Problem part = part_about(leg);
      const std::optional<Candidate> other =
          polished(part, kPullKnots, pull, budget, space_, deadline());
      if (!other) continue;
      if (bending_energy(other->path) > kMostBending * bending_energy(part.path)) continue;
      take_if_better(leg, Objective::kClosest, *other, part);
    }
  }

  void pursue(Objective objective) {
    const Improvement pursuit{.objective = objective, .may_turn = false, .worth = kPursuitWorth};
    base::Budget budget(kPursuitStepsPerLeg * static_cast<std::int64_t>(collisions_.count_legs()));
    const std::vector<bool> legs = collisions_.corrected_legs(corrected_);
    for (const int knots : kPursuitKnots) {
      for (std::size_t leg = 0; leg < legs.size() && !deadline().passed(); ++leg) {
        if (!legs[leg]) continue;
        const Problem part = part_about(leg);
        const std::optional<Candidate> other =
            polished(part, knots, pursuit, budget, space_, deadline());
        if (other) take_if_better(leg, objective, *other, part);
      }
    }
  }

 private:
  // The intervals that ended far from the interpolated path, the farthest first.
  [[nodiscard]] std::vector<std::size_t> far_legs() const {
    struct FarLeg {
      double deviation_m;
      std::size_t leg;
    };
    std::vector<FarLeg> far;
    const std::vector<bool> legs = collisions_.corrected_legs(corrected_);
    for (std::size_t leg = 0; leg < legs.size() && !deadline().passed(); ++leg) {
      if (!legs[leg]) continue;
      const Problem whole = part_about(leg);
      const CubicPath part = whole.path.around(whole.leg_begin_s(), whole.leg_end_s());
      const double deviation_m = cost(Objective::kClosest, part, whole).value;
      if (deviation_m > kFarFromReference * space_.ball_radius_m()) {
        far.push_back({deviation_m, leg});
      }
    }
    std::ranges::stable_sort(far, std::greater(), &FarLeg::deviation_m);
    std::vector<std::size_t> result;
    for (const FarLeg& place : far) result.push_back(place.leg);
    return result;
  }

  [[nodiscard]] Problem part_about(std::size_t leg) const {
    return collisions_.with_open_collisions(
        corrected_.part_about(leg, origin_, space_.ball_radius_m()));
  }

  [[nodiscard]] const base::Deadline& deadline() const { return corrected_.deadline(); }

  [[nodiscard]] ObjectiveCost cost(Objective objective, const CubicPath& path,
                                   const Problem& part) const {
    return objective_cost(objective, path, part.original, space_, deadline());
  }

  void take_if_better(std::size_t leg, Objective objective, const Candidate& other,
                      const Problem& part) {
    if (is_better(cost(objective, other.path, part), cost(objective, part.path, part))) {
      take(leg, other);
    }
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
};

}  // namespace

void polish(Objective objective, const motion::TimeOrigin& origin, base::Budget& budget,
            FreeSpace& space, CorrectedPath& corrected, CollisionList& collisions) {
  Polisher polisher(origin, space, corrected, collisions);
  polisher.relax(budget);
  polisher.pull_to_interpolated();
  if (objective != Objective::kClosest) polisher.pursue(objective);
}

}  // namespace camway::correction
