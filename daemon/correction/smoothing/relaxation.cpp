// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/relaxation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/correction/path/closeness.h"
#include "daemon/correction/smoothing/constrained_minimum.h"
#include "daemon/correction/smoothing/objective_cost.h"
#include "daemon/correction/smoothing/path_sample.h"

namespace camway::correction {

namespace {

using motion::CubicPoint;

// Chosen by measurement; none changes what is proved. Lengths are shares of the ball's radius.
constexpr int kFewestPerStep = 2;         // between two knots
constexpr int kMostPerStep = 8;           // the same
constexpr double kTravelPerSample = 1.0;  // travel of the eye between two samples
constexpr double kDenserForRoom = 2.0;    // samples, as the least gap lies between two of them
constexpr double kDenserForCurve = 2.0;   // samples of a curve that hugs what it passes
constexpr double kLeastKept = 0.995;      // share of the least gap that `kSafest` keeps
constexpr double kFirstTrust = 2.0;       // radius of the trust region
constexpr double kMostTrust = 4.0;
constexpr double kLeastTrust = 0.02;
constexpr double kDistrust = 0.3;
constexpr double kHorizon = 0.7;   // largest gap that is measured; `kSafest` adds kComfort
constexpr double kSettled = 0.05;  // a step that moves the body less is the last
constexpr double kGained = 0.01;   // share of the objective: a step that gains less is the last
constexpr double kSettledCurve = 0.02;  // the same two for a measure of the curve alone, whose
constexpr double kGainedCurve = 0.003;  // minimum is exact
constexpr double kGentler = 1.5;        // weight of acceleration in steps, relative to the cost
constexpr double kGentlerRoom = 2.0;    // the same in steps that make room
constexpr double kPriceOfRoom = 1.25;   // largest growth of the cost for wider gaps
constexpr int kMostCuts = 3;            // attempts at a step, each with more contacts
constexpr int kRounds = 3;              // rounds of relaxing, with more samples each time
constexpr int kStepsAgain = 4;          // of each round but the first, at least
constexpr double kRetreat = 0.6;
constexpr double kAffordable = 0.5;  // share of what is left of the price of room
constexpr int kLooks = 2;            // closer looks: the whole step, and what of it is affordable
constexpr int kRetreats = 3;         // moves back towards the initial correction
constexpr int kStepsAProof = 2;      // of a curve, as what is proved is not lost again
constexpr int kMostProofs = 16;      // of a curve

double horizon_m(Objective objective, double radius_m) {
  return (objective == Objective::kSafest ? kComfort + kHorizon : kHorizon) * radius_m;
}

/// A move by this length counts as much as a turn by a radian. Only the closest path weighs turns
/// by the shift of the picture.
double lever_of(Objective objective, const FreeSpace& space) {
  const double radius_m = space.ball_radius_m();
  if (objective != Objective::kClosest) return radius_m;
  return std::max(radius_m, space.closeness().turn_lever_m);
}

/// The scale of the form that steps minimise. It weighs acceleration more than the cost does: near
/// its minimum the cost hardly changes, but the acceleration does.
Closeness scale_of_steps(Closeness closeness, bool makes_room) {
  closeness.acceleration_m_per_s2 /= std::sqrt(makes_room ? kGentlerRoom : kGentler);
  return closeness;
}

/// The improvement as far as the space permits it.
Improvement limited(Improvement improvement, const FreeSpace& space) {
  improvement.may_turn = improvement.may_turn && space.may_turn();
  return improvement;
}

class Relaxation {
 public:
  Relaxation(const Problem& problem, const Offsets& offsets, Ends ends,
             const Improvement& improvement, FreeSpace& space)
      : radius_m_(space.ball_radius_m()),
        lever_m_(4.0 * lever_of(improvement.objective, space)),
        problem_(problem),
        objective_(improvement.objective),
        is_safest_(improvement.objective == Objective::kSafest),
        measures_curve_(measures_curve(improvement.objective)),
        may_turn_(limited(improvement, space).may_turn),
        makes_room_(improvement.makes_room),
        closeness_(space.closeness()),
        free_(problem, offsets.knots, ends),
        variables_(free_.variables_of(offsets, lever_m_)),
        form_(problem, free_, objective_, lever_m_, scale_of_steps(closeness_, makes_room_),
              variables_),
        minimum_(form_, limited(improvement, space), radius_m_,
                 space.closeness().viewing_distance_m),
        space_(space),
        probe_(problem, space, lever_m_, horizon_m(improvement.objective, radius_m_)) {
    for (int k = free_.first() - 2; k < free_.last() + 2; ++k) {
      add_samples(problem, offsets.knots.knot_s(k), offsets.knots.knot_s(k + 1));
    }
    if (is_safest_) keep_least_gap();
  }

  [[nodiscard]] Offsets offsets() const { return free_.offsets_of(variables_, lever_m_); }

  /// Whether the objective may fall by `share`, subject to the known contacts.
  [[nodiscard]] bool promises(double share) {
    if (is_safest_) return true;
    const double now = form_.value(variables_);
    return now - form_.value(minimum()) > share * now;
  }

  /// Avoiding obstacles may cost more than the other terms gain, and room has its price. Always
  /// true for `kSafest`, which gains gaps that the form does not contain.
  [[nodiscard]] bool is_no_worse(const Relaxed& now, const Relaxed& before) const {
    if (objective_ == Objective::kClosest) return cost(now) <= most_growth() * cost(before);
    return is_safest_ || form_.bounded_value(free_.variables_of(now.offsets, lever_m_)) <=
                             form_.bounded_value(free_.variables_of(before.offsets, lever_m_));
  }

  /// The share of the way from `before` to `now` that is tried first if `now` is too dear. The cost
  /// is convex, so on this share of the way it has grown by no more than room may cost.
  [[nodiscard]] double first_share(const Relaxed& now, const Relaxed& before) const {
    if (objective_ != Objective::kClosest || !makes_room_) return kRetreat;
    const double old = cost(before);
    return std::min(kRetreat, (most_growth() - 1.0) * old / (cost(now) - old));
  }

  /// The share of the way from `found` to the dearer `wider` that may cost `kAffordable` of what is
  /// left of the price of room. The cost is convex.
  [[nodiscard]] double affordable_share(const Relaxed& wider, const Relaxed& found,
                                        const Relaxed& before) const {
    const double now = cost(found);
    return kAffordable * (most_growth() * cost(before) - now) / (cost(wider) - now);
  }

  /// The largest length of the first step. [Units: metres]
  [[nodiscard]] double first_trust_m() const { return kFirstTrust * radius_m_; }

  /// Takes steps until the budget is spent, or a step gains little.
  void run(base::Budget& budget, const base::Deadline& deadline) {
    double trust_m = first_trust_m();
    run(budget, trust_m, deadline);
  }
  /// The same with `trust_m` as the largest length of the next step, which is adapted.
  void run(base::Budget& budget, double& trust_m, const base::Deadline& deadline) {
    while (budget.covers(1) && trust_m > kLeastTrust * radius_m_ && !deadline.passed()) {
      budget.spend(1);
      bound_cost();
      const double before = form_.value(variables_);
      const std::optional<double> moved_m = take_step(trust_m);
      if (!moved_m) return;
      if (*moved_m == 0.0) continue;
      if (*moved_m < (measures_curve_ ? kSettledCurve : kSettled) * radius_m_) return;
      const bool was_whole = *moved_m < 0.99 * trust_m;
      // Room is no part of the form.
      const bool form_is_all = !is_safest_ && !makes_room_;
      const double gained = measures_curve_ ? kGainedCurve : kGained;
      if (was_whole && form_is_all && before - form_.value(variables_) < gained * before) return;
      trust_m = std::min(2.0 * trust_m, kMostTrust * radius_m_);
    }
  }

  /// Adds samples in `collision` and moves the path back towards `free`, by as much as makes all
  /// samples free.
  void watch(const collision::CollisionInterval& collision, const Offsets& free) {
    const StackedPoints known = free_.variables_of(free, lever_m_);
    add_samples_in(collision, known);
    take_back(known, 0.5 * (collision.t_begin_s + collision.t_end_s));
    for (PathSample& sample : samples_) sample.has_rows = false;
  }

  /// Where the path passes the scene with next to no gap, if the relaxation makes room: the least
  /// gap lies between two samples.
  [[nodiscard]] std::optional<collision::CollisionInterval> tight_place(
      const Candidate& candidate, const base::Deadline& deadline) const {
    if (!makes_room_ || is_safest_) return std::nullopt;
    return correction::tight_place(candidate, minimum_.little_m(), problem_, space_, deadline);
  }

  /// Adds samples in `range`, where the path is free.
  void look_closer(const collision::CollisionInterval& range) {
    add_samples_in(range, variables_);
    for (PathSample& sample : samples_) sample.has_rows = false;
  }

 private:
  [[nodiscard]] double cost(const Relaxed& correction) const {
    return closeness_cost(correction.candidate.path, problem_.original, closeness_);
  }

  /// Makes a form that bounds its objective touch it at the path as it is.
  void bound_cost() {
    if (objective_ != Objective::kClosest && objective_ != Objective::kShortest) return;
    form_.bound_about(variables_);
  }

  /// The largest growth of the cost that is accepted, for `kClosest`.
  [[nodiscard]] double most_growth() const { return makes_room_ ? kPriceOfRoom : 1.0; }

  void add_sample(double time_s) {
    std::optional<PathSample> sample = probe_.sample_at(time_s, free_, variables_);
    if (sample) samples_.push_back(std::move(*sample));
  }

  /// Adds samples that are known to be free for the variables `known`, with their contacts.
  void add_samples_in(const collision::CollisionInterval& range, const StackedPoints& known) {
    const StackedPoints now = variables_;
    const std::size_t old = samples_.size();
    variables_ = known;
    for (const double share : {0.0, 0.5, 1.0}) {
      add_sample(std::lerp(range.t_begin_s, range.t_end_s, share));
    }
    variables_ = now;
    for (std::size_t i = old; i < samples_.size(); ++i) {
      probe_.check(samples_[i], samples_[i].at(variables_));
    }
  }

  void add_samples(const Problem& problem, double begin_s, double end_s) {
    const double travel_m =
        (problem.path.at(end_s).position - problem.path.at(begin_s).position).norm();
    const double wanted = std::ceil(travel_m / (kTravelPerSample * radius_m_));
    const double denser = measures_curve_ ? kDenserForCurve : makes_room_ ? kDenserForRoom : 1.0;
    const int count =
        static_cast<int>(denser * std::clamp(wanted, double{kFewestPerStep}, double{kMostPerStep}));
    for (int i = 0; i < count; ++i) add_sample(std::lerp(begin_s, end_s, (i + 0.5) / count));
  }

  /// `kSafest` may reduce gaps, but none below the least gap of the whole path.
  void keep_least_gap() {
    double least_m = minimum_.wanted_m();
    for (const PathSample& sample : samples_) {
      least_m = std::min(least_m, std::max(0.0, sample.known_gap_m));
    }
    for (PathSample& sample : samples_) {
      sample.floor_m = std::min(kLeastKept * least_m, sample.known_gap_m);
    }
    minimum_.keep(least_m);
  }

  void take_back(const StackedPoints& known, double time_s) {
    const StackedPoints moved = variables_;
    Eigen::Index middle = 0;
    for (const Term& term : free_.at(time_s)) middle = std::max(middle, term.variable);
    for (const double share : {0.3, 1.0}) {
      for (Eigen::Index width = 3; width < 2 * free_.size(); width *= 2) {
        const Eigen::Index low = std::max<Eigen::Index>(0, middle - width);
        const Eigen::Index count = std::min(free_.size(), middle + width) - low;
        variables_ = moved;
        variables_.middleRows(low, count) += share * (known - moved).middleRows(low, count);
        if (all_free_with(low, count)) return;
      }
    }
    variables_ = known;
    for (PathSample& sample : samples_) probe_.measure(sample, sample.at(variables_));
  }

  /// Whether all samples are free that `count` variables from `low` on move.
  [[nodiscard]] bool all_free_with(Eigen::Index low, Eigen::Index count) {
    return std::ranges::all_of(samples_, [&](PathSample& sample) {
      const bool uses = std::ranges::any_of(sample.terms, [&](const Term& term) {
        return low <= term.variable && term.variable < low + count;
      });
      return !uses || probe_.check(sample, sample.at(variables_)).is_free;
    });
  }

  /// Steps towards the constrained minimum as far as the samples stay free, and at most `trust_m`.
  /// Returns the length of the step; nothing at the minimum or if no step is possible; 0 if it must
  /// be repeated with the reduced `trust_m`.
  std::optional<double> take_step(double& trust_m) {
    Convergence convergence = Convergence::kUsual;
    for (int cut = 0; cut < kMostCuts; ++cut) {
      const StackedPoints whole = minimum(convergence) - variables_;
      const double whole_m = length_m(whole);
      if (whole_m == 0.0) return std::nullopt;
      SampleCheck check;
      for (; trust_m > kLeastTrust * radius_m_; trust_m *= kDistrust) {
        const double moved_m = std::min(whole_m, trust_m);
        StackedPoints step = whole_m > trust_m ? StackedPoints(trust_m / whole_m * whole) : whole;
        check = try_step(step);
        if (!check.is_free && !check.found_contact && check.breaks_rule) {
          // The turn violated the orientation policy: retry the step without it.
          step.rightCols<4>().setZero();
          check = try_step(step);
        }
        if (check.is_free) return moved_m;
        if (check.found_contact) break;
        // Between contacts that face each other, the usual sweeps satisfy the one or the other, and
        // only steps that hardly move remain free.
        if (check.is_squeezed && convergence == Convergence::kUsual) break;
        trust_m = moved_m;
      }
      if (!check.found_contact) {
        if (!check.is_squeezed || convergence == Convergence::kSettled) return std::nullopt;
        convergence = Convergence::kSettled;
      }
    }
    trust_m *= kDistrust;
    return 0.0;
  }

  /// The largest distance that a change of the variables moves a sample.
  [[nodiscard]] double length_m(const StackedPoints& change) const {
    double length_m = 0.0;
    for (const PathSample& sample : samples_) {
      const StackedPoint step = combined(sample.terms, change);
      length_m = std::max(length_m, step.head<3>().norm() + step.tail<4>().norm());
    }
    return length_m;
  }

  /// Adds `change` to the variables if all samples stay free.
  SampleCheck try_step(const StackedPoints& change) {
    SampleCheck check;
    for (PathSample& sample : samples_) {
      check += probe_.check(sample, sample.at(variables_) + combined(sample.terms, change));
    }
    if (!check.is_free) return check;
    variables_ += change;
    for (PathSample& sample : samples_) sample.has_rows = false;
    return check;
  }

  /// The minimum of the objective subject to the linearised contacts.
  StackedPoints minimum(Convergence convergence = Convergence::kUsual) {
    for (PathSample& sample : samples_) {
      if (sample.contacts.empty()) continue;
      probe_.update_rows(sample, sample.at(variables_), may_turn_, minimum_.wanted_m());
    }
    return minimum_.find(variables_, samples_, convergence);
  }

  const double radius_m_;
  const double lever_m_;
  const Problem& problem_;
  const Objective objective_;
  const bool is_safest_;
  const bool measures_curve_;
  const bool may_turn_;
  const bool makes_room_;
  const Closeness& closeness_;
  const FreeCoefficients free_;
  StackedPoints variables_;
  SmoothingForm form_;
  ConstrainedMinimum minimum_;
  const FreeSpace& space_;
  SampleProbe probe_;
  std::vector<PathSample> samples_;
};

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

/// Makes room once more where `found` has next to none, as far as that is free and not too dear.
Relaxed with_closer_look(const Problem& problem, Relaxation& relaxation, Relaxed found,
                         const Relaxed& free, Ends ends, FreeSpace& space,
                         const base::Deadline& deadline) {
  const std::optional<collision::CollisionInterval> tight =
      relaxation.tight_place(found.candidate, deadline);
  if (!tight) return found;
  const double tight_s = std::midpoint(tight->t_begin_s, tight->t_end_s);
  const auto gap_m = [&](const Relaxed& at) {
    return space.gap_m(at.candidate.path.pose(tight_s), space.ball_radius_m());
  };
  relaxation.look_closer(*tight);
  base::Budget steps(kStepsAgain);
  relaxation.run(steps, deadline);
  Offsets offsets = relaxation.offsets();
  for (int i = 0; i < kLooks; ++i) {
    std::optional<Candidate> tried =
        free_candidate(problem, {bumps_for(offsets, ends)}, space, deadline);
    ++found.paths;
    if (!tried) break;
    Relaxed wider{offsets, *std::move(tried), found.paths};
    if (relaxation.is_no_worse(wider, free)) return gap_m(wider) > gap_m(found) ? wider : found;
    offsets = mixed(found.offsets, offsets, relaxation.affordable_share(wider, found, free));
  }
  return found;
}

/// The first of some places between `better` and the free correction `free` that is free and no
/// worse, or else `free`. `share`: that of the first place, from `free`.
Relaxed retreated(const Problem& problem, const Relaxation& relaxation, Relaxed free,
                  const Offsets& better, double share, Ends ends, FreeSpace& space,
                  const base::Deadline& deadline) {
  for (int i = 0; i < kRetreats && !deadline.passed(); ++i, share *= kRetreat) {
    const Offsets between = mixed(free.offsets, better, share);
    std::optional<Candidate> tried =
        free_candidate(problem, {bumps_for(between, ends)}, space, deadline);
    ++free.paths;
    if (!tried) continue;
    Relaxed found{between, *std::move(tried), free.paths};
    if (relaxation.is_no_worse(found, free)) return found;
  }
  return free;
}

/// Relaxes the free correction `free`, and proves the result.
Relaxed proved(const Problem& problem, Relaxation& relaxation, Relaxed free, Ends ends,
               base::Budget& budget, FreeSpace& space, const base::Deadline& deadline) {
  Offsets better = free.offsets;
  double share = kRetreat;
  for (int i = 0; i < kRounds && !deadline.passed(); ++i) {
    // A step may jump over what is thin. The path is taken back then, and more contacts are known.
    base::Budget again(kStepsAgain);
    relaxation.run(i == 0 || budget.covers(kStepsAgain) ? budget : again, deadline);
    better = relaxation.offsets();
    Attempt tried = attempt(problem, {bumps_for(better, ends)}, space, deadline);
    ++free.paths;
    if (tried.candidate) {
      Relaxed found{better, std::move(*tried.candidate), free.paths};
      if (relaxation.is_no_worse(found, free)) {
        return with_closer_look(problem, relaxation, std::move(found), free, ends, space, deadline);
      }
      share = relaxation.first_share(found, free);
      break;
    }
    // The path collides between the samples: add samples there.
    relaxation.watch(*tried.collision, free.offsets);
  }
  return retreated(problem, relaxation, std::move(free), better, share, ends, space, deadline);
}

/// The same with a proof after every few steps. A proof that fails costs these alone, and so it
/// pays to take many steps past what is thin.
Relaxed proved_by_parts(const Problem& problem, Relaxation& relaxation, Relaxed free, Ends ends,
                        base::Budget& budget, FreeSpace& space, const base::Deadline& deadline) {
  double trust_m = relaxation.first_trust_m();
  Offsets better = free.offsets;
  for (int i = 0; i < kMostProofs && !deadline.passed(); ++i) {
    // Steps that repair a failed proof are taken beside those of the budget.
    const bool is_spent = !budget.covers(1);
    base::Budget steps = is_spent ? base::Budget(kStepsAProof) : budget.take(kStepsAProof);
    relaxation.run(steps, trust_m, deadline);
    const bool is_settled = steps.covers(1);
    if (!is_spent) budget.put_back(steps);
    better = relaxation.offsets();
    Attempt tried = attempt(problem, {bumps_for(better, ends)}, space, deadline);
    ++free.paths;
    if (!tried.candidate) {
      relaxation.watch(*tried.collision, free.offsets);
      trust_m = relaxation.first_trust_m();
      continue;
    }
    Relaxed found{better, std::move(*tried.candidate), free.paths};
    if (!relaxation.is_no_worse(found, free)) break;
    free = std::move(found);
    if (is_settled || !budget.covers(1)) return free;
  }
  return retreated(problem, relaxation, std::move(free), better, kRetreat, ends, space, deadline);
}

/// Relaxes the free correction `free` as the objective requires, and proves the result.
Relaxed proved_by_objective(const Problem& problem, Relaxation& relaxation, Relaxed free, Ends ends,
                            const Improvement& improvement, base::Budget& budget, FreeSpace& space,
                            const base::Deadline& deadline) {
  base::Budget steps = budget.take(improvement.most_steps);
  const auto& prove = measures_curve(improvement.objective) ? proved_by_parts : proved;
  Relaxed better = prove(problem, relaxation, std::move(free), ends, steps, space, deadline);
  budget.put_back(steps);
  return better;
}

}  // namespace

Relaxed relaxed(const Problem& problem, Relaxed free, Ends ends, const Improvement& improvement,
                base::Budget& budget, FreeSpace& space, const base::Deadline& deadline) {
  if (!budget.covers(1)) return free;
  Relaxation relaxation(problem, free.offsets, ends, improvement, space);
  return proved_by_objective(problem, relaxation, std::move(free), ends, improvement, budget, space,
                             deadline);
}

std::optional<Candidate> polished(const Problem& problem, int knots, const Improvement& improvement,
                                  base::Budget& budget, FreeSpace& space,
                                  const base::Deadline& deadline) {
  if (!budget.covers(1)) return std::nullopt;
  const Offsets none{problem.knots(knots), 1, {}};
  if (!none.knots.fits()) return std::nullopt;
  const Ends ends = fits_free_ends(problem, none.knots) ? Ends::kFree : Ends::kFixed;
  Relaxation relaxation(problem, none, ends, improvement, space);
  if (!relaxation.promises(improvement.worth)) return std::nullopt;
  Relaxed better = proved_by_objective(problem, relaxation, {none, {}}, ends, improvement, budget,
                                       space, deadline);
  if (better.candidate.rows.empty()) return std::nullopt;
  return std::move(better.candidate);
}

}  // namespace camway::correction
