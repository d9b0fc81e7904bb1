// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/polish.h"

#include <array>
#include <optional>
#include <vector>

#include "daemon/correction/smoothing/objective_cost.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

namespace {

// Chosen by measurement; none changes what is proved.
constexpr int kPursuitStepsPerLeg = 40;
constexpr double kPursuitWorth = 0.03;
constexpr std::array<int, 4> kPursuitKnots = {6, 12, 24, 48};

class Polisher {
 public:
  Polisher(const motion::TimeOrigin& origin, FreeSpace& space, CorrectedPath& corrected,
           CollisionList& collisions)
      : origin_(origin), space_(space), corrected_(corrected), collisions_(collisions) {}

  bool pursue(Objective objective) {
    bool gains = false;
    const Improvement pursuit{.objective = objective, .may_turn = false, .worth = kPursuitWorth};
    base::Budget budget(kPursuitStepsPerLeg * static_cast<std::int64_t>(collisions_.count_legs()));
    const std::vector<bool> legs = collisions_.corrected_legs(corrected_);
    for (const int knots : kPursuitKnots) {
      for (std::size_t leg = 0; leg < legs.size() && !deadline().passed(); ++leg) {
        if (!legs[leg]) continue;
        const Problem part = part_about(leg);
        const std::optional<Candidate> other =
            polished(part, knots, pursuit, budget, space_, deadline());
        if (other && take_if_better(leg, objective, *other, part)) gains = true;
      }
    }
    return gains;
  }

 private:
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
};

}  // namespace

bool polish(Objective objective, const motion::TimeOrigin& origin, FreeSpace& space,
            CorrectedPath& corrected, CollisionList& collisions) {
  Polisher polisher(origin, space, corrected, collisions);
  return objective != Objective::kClosest && polisher.pursue(objective);
}

}  // namespace camway::correction
