// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/relaxation.h"

#include <numeric>
#include <optional>
#include <utility>

#include "daemon/correction/smoothing/relaxation_steps.h"

namespace camway::correction {

namespace {

using motion::CubicPoint;

// Chosen by measurement; none changes what is proved.
constexpr int kRounds = 3;       // rounds of relaxing, with more samples each time
constexpr int kStepsAgain = 4;   // of each round but the first, at least
constexpr int kLooks = 2;        // closer looks: the whole step, and what of it is affordable
constexpr int kRetreats = 3;     // moves back towards the initial correction
constexpr int kStepsAProof = 2;  // of a curve, as what is proved is not lost again
constexpr int kMostProofs = 16;  // of a curve

Offsets mixed(const Offsets& a, const Offsets& b, double share_of_b) {
  Offsets result = b;
  for (int k = b.first; k <= b.last(); ++k) {
    CubicPoint& at = result.at[static_cast<std::size_t>(k - b.first)];
    const CubicPoint from = a(k);
    at.position = (1.0 - share_of_b) * from.position + share_of_b * at.position;
    at.image = (1.0 - share_of_b) * from.image + share_of_b * at.image;
  }
  return result;
}

/// A relaxation whose result is proved.
class ProvedRelaxation {
 public:
  ProvedRelaxation(const Problem& problem, const Offsets& offsets, Ends ends,
                   const Improvement& improvement, FreeSpace& space, const base::Deadline& deadline)
      : problem_(problem),
        ends_(ends),
        improvement_(improvement),
        space_(space),
        deadline_(deadline),
        relaxation_(problem, offsets, ends, improvement, space) {}

  [[nodiscard]] bool promises(double share) { return relaxation_.promises(share); }

  /// Relaxes the free correction `free` as the objective requires, and proves the result.
  [[nodiscard]] Relaxed run(Relaxed free, base::Budget& budget) {
    base::Budget steps = budget.take(improvement_.most_steps);
    Relaxed better = measures_curve(improvement_.objective) ? by_parts(std::move(free), steps)
                                                            : as_a_whole(std::move(free), steps);
    budget.put_back(steps);
    return better;
  }

 private:
  [[nodiscard]] Relaxed as_a_whole(Relaxed free, base::Budget& budget) {
    Offsets better = free.offsets;
    double share = kRetreat;
    for (int i = 0; i < kRounds && !deadline_.passed(); ++i) {
      // A step may jump over what is thin. The path is taken back then, and more contacts are
      // known.
      base::Budget again(kStepsAgain);
      relaxation_.run(i == 0 || budget.covers(kStepsAgain) ? budget : again, deadline_);
      better = relaxation_.offsets();
      Attempt tried = attempt(problem_, {bumps_for(better, ends_)}, space_, deadline_);
      ++free.paths;
      if (tried.candidate) {
        Relaxed found{better, std::move(*tried.candidate), free.paths};
        if (relaxation_.is_no_worse(found, free)) return with_closer_look(std::move(found), free);
        share = relaxation_.first_share(found, free);
        break;
      }
      // The path collides between the samples: add samples there.
      relaxation_.watch(*tried.collision, free.offsets);
    }
    return retreated(std::move(free), better, share);
  }

  /// The same with a proof after every few steps. A proof that fails costs these alone, and so it
  /// pays to take many steps past what is thin.
  [[nodiscard]] Relaxed by_parts(Relaxed free, base::Budget& budget) {
    double trust_m = relaxation_.first_trust_m();
    Offsets better = free.offsets;
    for (int i = 0; i < kMostProofs && !deadline_.passed(); ++i) {
      // Steps that repair a failed proof are taken beside those of the budget.
      const bool is_spent = !budget.covers(1);
      base::Budget steps = is_spent ? base::Budget(kStepsAProof) : budget.take(kStepsAProof);
      relaxation_.run(steps, trust_m, deadline_);
      const bool is_settled = steps.covers(1);
      if (!is_spent) budget.put_back(steps);
      better = relaxation_.offsets();
      Attempt tried = attempt(problem_, {bumps_for(better, ends_)}, space_, deadline_);
      ++free.paths;
      if (!tried.candidate) {
        relaxation_.watch(*tried.collision, free.offsets);
        trust_m = relaxation_.first_trust_m();
        continue;
      }
      Relaxed found{better, std::move(*tried.candidate), free.paths};
      if (!relaxation_.is_no_worse(found, free)) break;
      free = std::move(found);
      if (is_settled || !budget.covers(1)) return free;
    }
    return retreated(std::move(free), better, kRetreat);
  }

  /// Makes room once more where `found` has next to none, as far as that is free and not too dear.
  [[nodiscard]] Relaxed with_closer_look(Relaxed found, const Relaxed& free) {
    const std::optional<collision::CollisionInterval> tight =
        relaxation_.tight_place(found.candidate, deadline_);
    if (!tight) return found;
    const double tight_s = std::midpoint(tight->t_begin_s, tight->t_end_s);
    const auto gap_m = [&](const Relaxed& at) {
      return space_.gap_m(at.candidate.path.pose(tight_s), space_.ball_radius_m());
    };
    relaxation_.look_closer(*tight);
    base::Budget steps(kStepsAgain);
    relaxation_.run(steps, deadline_);
    Offsets offsets = relaxation_.offsets();
    for (int i = 0; i < kLooks; ++i) {
      std::optional<Candidate> tried =
          free_candidate(problem_, {bumps_for(offsets, ends_)}, space_, deadline_);
      ++found.paths;
      if (!tried) break;
      Relaxed wider{offsets, *std::move(tried), found.paths};
      if (relaxation_.is_no_worse(wider, free)) {
        return gap_m(wider) > gap_m(found) ? wider : found;
      }
      offsets = mixed(found.offsets, offsets, relaxation_.affordable_share(wider, found, free));
    }
    return found;
  }

  /// The first of some places between `better` and the free correction `free` that is free and no
  /// worse, or else `free`. `share`: that of the first place, from `free`.
  [[nodiscard]] Relaxed retreated(Relaxed free, const Offsets& better, double share) const {
    for (int i = 0; i < kRetreats && !deadline_.passed(); ++i, share *= kRetreat) {
      const Offsets between = mixed(free.offsets, better, share);
      std::optional<Candidate> tried =
          free_candidate(problem_, {bumps_for(between, ends_)}, space_, deadline_);
      ++free.paths;
      if (!tried) continue;
      Relaxed found{between, *std::move(tried), free.paths};
      if (relaxation_.is_no_worse(found, free)) return found;
    }
    return free;
  }

  const Problem& problem_;
  const Ends ends_;
  const Improvement& improvement_;
  FreeSpace& space_;
  const base::Deadline& deadline_;
  Relaxation relaxation_;
};

}  // namespace

Relaxed relaxed(const Problem& problem, Relaxed free, Ends ends, const Improvement& improvement,
                base::Budget& budget, FreeSpace& space, const base::Deadline& deadline) {
  if (!budget.covers(1)) return free;
  ProvedRelaxation relaxation(problem, free.offsets, ends, improvement, space, deadline);
  return relaxation.run(std::move(free), budget);
}

std::optional<Candidate> polished(const Problem& problem, int knots, const Improvement& improvement,
                                  base::Budget& budget, FreeSpace& space,
                                  const base::Deadline& deadline) {
  if (!budget.covers(1)) return std::nullopt;
  const Offsets none{problem.knots(knots), 1, {}};
  if (!none.knots.fits()) return std::nullopt;
  const Ends ends = fits_free_ends(problem, none.knots) ? Ends::kFree : Ends::kFixed;
  ProvedRelaxation relaxation(problem, none, ends, improvement, space, deadline);
  if (!relaxation.promises(improvement.worth)) return std::nullopt;
  Relaxed better = relaxation.run({none, {}}, budget);
  if (better.candidate.rows.empty()) return std::nullopt;
  return std::move(better.candidate);
}

}  // namespace camway::correction
