// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/relaxation_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "daemon/correction/smoothing/objective_cost.h"

namespace camway::correction {

namespace {

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
constexpr double kWholeStep = 0.99;     // share of the trust region: a longer step was cut
constexpr int kMostCuts = 3;            // attempts at a step, each with more contacts
constexpr double kAffordable = 0.5;     // share of what is left of the price of room
constexpr std::array<double, 2> kSharesTakenBack = {0.3, 1.0};  // of a change that is not free
constexpr Eigen::Index kFirstWidth = 3;  // variables to either side that are taken back first

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

}  // namespace

Relaxation::Relaxation(const Problem& problem, const Offsets& offsets, Ends ends,
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
      minimum_(form_, limited(improvement, space), radius_m_, space.closeness().viewing_distance_m),
      space_(space),
      probe_(problem, space, lever_m_, horizon_m(improvement.objective, radius_m_)) {
  for (int k = free_.first() - 2; k < free_.last() + 2; ++k) {
    add_samples(problem, offsets.knots.knot_s(k), offsets.knots.knot_s(k + 1));
  }
  if (is_safest_) keep_least_gap();
}

bool Relaxation::promises(double share) {
  if (is_safest_) return true;
  const double now = form_.value(variables_);
  return now - form_.value(minimum()) > share * now;
}

bool Relaxation::is_no_worse(const Relaxed& now, const Relaxed& before) const {
  if (objective_ == Objective::kClosest) return cost(now) <= most_growth() * cost(before);
  return is_safest_ || form_.bounded_value(free_.variables_of(now.offsets, lever_m_)) <=
                           form_.bounded_value(free_.variables_of(before.offsets, lever_m_));
}

double Relaxation::first_share(const Relaxed& now, const Relaxed& before) const {
  if (objective_ != Objective::kClosest || !makes_room_) return kRetreat;
  const double old = cost(before);
  return std::min(kRetreat, (most_growth() - 1.0) * old / (cost(now) - old));
}

double Relaxation::affordable_share(const Relaxed& wider, const Relaxed& found,
                                    const Relaxed& before) const {
  const double now = cost(found);
  return kAffordable * (most_growth() * cost(before) - now) / (cost(wider) - now);
}

double Relaxation::first_trust_m() const { return kFirstTrust * radius_m_; }

void Relaxation::run(base::Budget& budget, const base::Deadline& deadline) {
  double trust_m = first_trust_m();
  run(budget, trust_m, deadline);
}

void Relaxation::run(base::Budget& budget, double& trust_m, const base::Deadline& deadline) {
  while (budget.covers(1) && trust_m > kLeastTrust * radius_m_ && !deadline.passed()) {
    budget.spend(1);
    bound_cost();
    const double before = form_.value(variables_);
    const std::optional<double> moved_m = take_step(trust_m);
    if (!moved_m) return;
    if (*moved_m == 0.0) continue;
    if (*moved_m < (measures_curve_ ? kSettledCurve : kSettled) * radius_m_) return;
    const bool was_whole = *moved_m < kWholeStep * trust_m;
    // Room is no part of the form.
    const bool form_is_all = !is_safest_ && !makes_room_;
    const double gained = measures_curve_ ? kGainedCurve : kGained;
    if (was_whole && form_is_all && before - form_.value(variables_) < gained * before) return;
    trust_m = std::min(2.0 * trust_m, kMostTrust * radius_m_);
  }
}

void Relaxation::watch(const collision::CollisionInterval& collision, const Offsets& free) {
  const StackedPoints known = free_.variables_of(free, lever_m_);
  add_samples_in(collision, known);
  take_back(known, 0.5 * (collision.t_begin_s + collision.t_end_s));
  for (PathSample& sample : samples_) sample.has_rows = false;
}

std::optional<collision::CollisionInterval> Relaxation::tight_place(
    const Candidate& candidate, const base::Deadline& deadline) const {
  if (!makes_room_ || is_safest_) return std::nullopt;
  return correction::tight_place(candidate, minimum_.little_m(), problem_, space_, deadline);
}

void Relaxation::look_closer(const collision::CollisionInterval& range) {
  add_samples_in(range, variables_);
  for (PathSample& sample : samples_) sample.has_rows = false;
}

double Relaxation::cost(const Relaxed& correction) const {
  return closeness_cost(correction.candidate.path, problem_.original, closeness_);
}

void Relaxation::bound_cost() {
  if (objective_ != Objective::kClosest && objective_ != Objective::kShortest) return;
  form_.bound_about(variables_);
}

double Relaxation::most_growth() const { return makes_room_ ? kPriceOfRoom : 1.0; }

void Relaxation::add_sample(double time_s) {
  std::optional<PathSample> sample = probe_.sample_at(time_s, free_, variables_);
  if (sample) samples_.push_back(std::move(*sample));
}

void Relaxation::add_samples_in(const collision::CollisionInterval& range,
                                const StackedPoints& known) {
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

void Relaxation::add_samples(const Problem& problem, double begin_s, double end_s) {
  const double travel_m =
      (problem.path.at(end_s).position - problem.path.at(begin_s).position).norm();
  const double wanted = std::ceil(travel_m / (kTravelPerSample * radius_m_));
  const double denser = measures_curve_ ? kDenserForCurve : makes_room_ ? kDenserForRoom : 1.0;
  const int count =
      static_cast<int>(denser * std::clamp(wanted, double{kFewestPerStep}, double{kMostPerStep}));
  for (int i = 0; i < count; ++i) add_sample(std::lerp(begin_s, end_s, (i + 0.5) / count));
}

void Relaxation::keep_least_gap() {
  double least_m = minimum_.wanted_m();
  for (const PathSample& sample : samples_) {
    least_m = std::min(least_m, std::max(0.0, sample.known_gap_m));
  }
  for (PathSample& sample : samples_) {
    sample.floor_m = std::min(kLeastKept * least_m, sample.known_gap_m);
  }
  minimum_.keep(least_m);
}

void Relaxation::take_back(const StackedPoints& known, double time_s) {
  const StackedPoints moved = variables_;
  Eigen::Index middle = 0;
  for (const Term& term : free_.at(time_s)) middle = std::max(middle, term.variable);
  for (const double share : kSharesTakenBack) {
    for (Eigen::Index width = kFirstWidth; width < 2 * free_.size(); width *= 2) {
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

bool Relaxation::all_free_with(Eigen::Index low, Eigen::Index count) {
  return std::ranges::all_of(samples_, [&](PathSample& sample) {
    const bool uses = std::ranges::any_of(sample.terms, [&](const Term& term) {
      return low <= term.variable && term.variable < low + count;
    });
    return !uses || probe_.check(sample, sample.at(variables_)).is_free;
  });
}

std::optional<double> Relaxation::take_step(double& trust_m) {
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

double Relaxation::length_m(const StackedPoints& change) const {
  double length_m = 0.0;
  for (const PathSample& sample : samples_) {
    const StackedPoint step = combined(sample.terms, change);
    length_m = std::max(length_m, step.head<3>().norm() + step.tail<4>().norm());
  }
  return length_m;
}

SampleCheck Relaxation::try_step(const StackedPoints& change) {
  SampleCheck check;
  for (PathSample& sample : samples_) {
    check += probe_.check(sample, sample.at(variables_) + combined(sample.terms, change));
  }
  if (!check.is_free) return check;
  variables_ += change;
  for (PathSample& sample : samples_) sample.has_rows = false;
  return check;
}

StackedPoints Relaxation::minimum(Convergence convergence) {
  for (PathSample& sample : samples_) {
    if (sample.contacts.empty()) continue;
    probe_.update_rows(sample, sample.at(variables_), may_turn_, minimum_.wanted_m());
  }
  return minimum_.find(variables_, samples_, convergence);
}

}  // namespace camway::correction
