// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/relaxation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "daemon/correction/path/orientation_rule.h"
#include "daemon/correction/smoothing/contact_bounds.h"
#include "daemon/correction/smoothing/objective_cost.h"

namespace camway::correction {

namespace {

using motion::CubicPoint;

// Chosen by measurement; none changes what is proved. Lengths are shares of the ball's radius.
constexpr int kSamplesAStep = 2;      // between two knots
constexpr double kFloor = 0.03;       // least gap that a step may leave, ...
constexpr double kKeptShare = 0.8;    // ... or this share of what there was, where that is less
constexpr double kLeastKept = 0.995;  // share of the least gap that `kSafest` keeps
constexpr double kRuleMargin = 0.3 * kOrientationAllowance_rad;  // least room at the samples
constexpr double kFirstTrust = 2.0;                              // radius of the trust region
constexpr double kMostTrust = 4.0;
constexpr double kLeastTrust = 0.02;
constexpr double kDistrust = 0.3;
constexpr double kHorizon = 1.0;    // largest gap that is measured; `kSafest` adds kComfort
constexpr double kFarEnough = 0.5;  // share of the horizon beyond which a lower bound suffices
constexpr double kSettled = 0.05;   // a step that moves the body less is the last
constexpr double kGained = 0.01;    // share of the objective: a step that gains less is the last
constexpr int kMostSteps = 12;
constexpr int kMostCuts = 3;              // attempts at a step, each with more contacts
constexpr double kForceSettled = 1e-3;    // convergence threshold of the multipliers
constexpr std::size_t kMostContacts = 3;  // contacts per sample
constexpr int kRounds = 3;                // rounds of relaxing, with more samples each time
constexpr double kRetreat = 0.6;
constexpr int kRetreats = 3;  // moves back towards the initial correction

/// A time at which the relaxation checks that the body is free.
struct Sample {
  StackedPoint path;
  Terms terms;
  double floor_m = 0.0;       ///< least gap that a step must leave
  motion::Pose interpolated;  ///< reference of the orientation policy
  double rule_floor = 0.0;    ///< least room of the orientation policy that a step must leave
  /// The last pose with a known gap. The gap is queried again only after the body has moved by as
  /// much.
  StackedPoint known;
  double known_gap_m = 0.0;
  std::vector<std::uint32_t> contacts;  ///< obstacles that the body may meet, the latest last
  std::vector<Contact> rows;            ///< their constraints at the current path
  bool has_rows = false;                ///< whether `rows` is up to date
};

class Relaxation {
 public:
  /// Spends at most `steps_left` steps and subtracts them.
  Relaxation(const Problem& problem, const Offsets& offsets, Ends ends,
             const Improvement& improvement, FreeSpace& space, int& steps_left)
      : problem_(problem),
        space_(space),
        radius_m_(space.ball_radius_m()),
        lever_m_(4.0 * radius_m_),
        is_safest_(improvement.objective == Objective::kSafest),
        may_turn_(space.may_turn() && improvement.may_turn),
        bounds_(improvement.objective, radius_m_),
        horizon_m_((is_safest_ ? kComfort + kHorizon : kHorizon) * radius_m_),
        free_(problem, offsets.knots, ends),
        form_(problem, free_, improvement.objective, lever_m_, improvement.spread),
        variables_(free_.variables_of(offsets, lever_m_)),
        steps_left_(steps_left) {
    const double step_s = offsets.knots.spacing_s();
    for (int k = free_.first() - 2; k < free_.last() + 2; ++k) {
      for (int m = 0; m < kSamplesAStep; ++m)
        add_sample(offsets.knots.knot_s(k) + (m + 0.5) / kSamplesAStep * step_s);
    }
    if (is_safest_) keep_least_gap();
  }

  [[nodiscard]] Offsets offsets() const { return free_.offsets_of(variables_, lever_m_); }

  /// Whether the objective may fall by `share`, subject to the known contacts.
  [[nodiscard]] bool promises(double share) {
    if (is_safest_) return true;
    const double now = form_.value(variables_);
    return now - form_.value(solved()) > share * now;
  }

  /// Avoiding obstacles may cost more than the other terms gain. Always true for `kSafest`, which
  /// gains gaps that the form does not contain.
  [[nodiscard]] bool is_no_worse(const Offsets& now, const Offsets& before) const {
    return is_safest_ || form_.value(free_.variables_of(now, lever_m_)) <=
                             form_.value(free_.variables_of(before, lever_m_));
  }

  void run(const collision::Deadline& deadline) {
    const double first_value = form_.value(variables_);
    double trust_m = kFirstTrust * radius_m_;
    while (steps_left_ > 0 && trust_m > kLeastTrust * radius_m_ && !deadline.passed()) {
      --steps_left_;
      const double before = form_.value(variables_);
      const std::optional<double> moved_m = take_step(trust_m);
      if (!moved_m) return;
      if (*moved_m == 0.0) continue;
      if (*moved_m < kSettled * radius_m_) return;
      const bool was_whole = *moved_m < 0.99 * trust_m;
      if (was_whole && !is_safest_ && before - form_.value(variables_) < kGained * first_value)
        return;
      trust_m = std::min(2.0 * trust_m, kMostTrust * radius_m_);
    }
  }

  /// Adds samples in `collision` and moves the path back towards `free`, by as much as makes all
  /// samples free.
  void watch(const collision::CollisionInterval& collision, const Offsets& free) {
    const StackedPoints known = free_.variables_of(free, lever_m_);
    const StackedPoints moved = variables_;
    const std::size_t old = samples_.size();
    variables_ = known;
    for (const double share : {0.0, 0.5, 1.0})
      add_sample(std::lerp(collision.t_begin_s, collision.t_end_s, share));
    variables_ = moved;
    // Adds contacts for the obstacles of the new samples.
    for (std::size_t i = old; i < samples_.size(); ++i) is_free(samples_[i], point(samples_[i]));
    take_back(known, 0.5 * (collision.t_begin_s + collision.t_end_s));
    for (Sample& sample : samples_) sample.has_rows = false;
  }

 private:
  void add_sample(double time_s) {
    if (time_s <= problem_.path.begin_s() || time_s >= problem_.path.end_s()) return;
    if (is_others(time_s)) return;
    Sample sample;
    sample.path = stacked(problem_.path.at(time_s), lever_m_);
    sample.terms = free_.at(time_s);
    if (sample.terms.empty()) return;
    sample.interpolated = problem_.original.pose(time_s);
    look(sample);
    const double room = rule_room(space_.policy(), pose(sample.known), sample.interpolated);
    sample.rule_floor = std::min(kRuleMargin, kKeptShare * std::max(0.0, room));
    sample.floor_m = std::min(kFloor * radius_m_, kKeptShare * std::max(0.0, sample.known_gap_m));
    samples_.push_back(std::move(sample));
  }

  /// `kSafest` may reduce gaps, but none below the least gap of the whole path.
  void keep_least_gap() {
    double least_m = bounds_.wanted_m();
    for (const Sample& sample : samples_)
      least_m = std::min(least_m, std::max(0.0, sample.known_gap_m));
    for (Sample& sample : samples_)
      sample.floor_m = std::min(kLeastKept * least_m, sample.known_gap_m);
    bounds_.keep(least_m);
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
        const bool all_free = std::ranges::all_of(samples_, [&](Sample& sample) {
          const bool uses = std::ranges::any_of(sample.terms, [&](const Term& term) {
            return low <= term.variable && term.variable < low + count;
          });
          return !uses || is_free(sample, point(sample));
        });
        if (all_free) return;
      }
    }
    variables_ = known;
    for (Sample& sample : samples_) look(sample);
  }

  [[nodiscard]] bool is_others(double time_s) const {
    return std::ranges::any_of(problem_.others, [&](const collision::CollisionInterval& other) {
      return other.t_begin_s <= time_s && time_s <= other.t_end_s;
    });
  }

  [[nodiscard]] StackedPoint point(const Sample& sample) const {
    return sample.path + combined(sample.terms, variables_);
  }

  [[nodiscard]] motion::Pose pose(const StackedPoint& point) const {
    return motion::pose_of(problem_.path.reference, unstacked(point, lever_m_));
  }

  [[nodiscard]] static double distance_m(const StackedPoint& a, const StackedPoint& b) {
    return (a.head<3>() - b.head<3>()).norm() + (a.tail<4>() - b.tail<4>()).norm();
  }

  void look(Sample& sample) {
    sample.known = point(sample);
    sample.known_gap_m = gap_m(sample, sample.known);
  }

  /// Returns about the gap of the body, at most `horizon_m_` or a lower bound beyond it, and adds a
  /// contact for the nearest obstacle.
  double gap_m(Sample& sample, const StackedPoint& there) {
    const motion::Pose pose = this->pose(there);
    const double at_least_m = space_.at_least_m(pose);
    if (at_least_m > kFarEnough * horizon_m_) return at_least_m;
    const std::optional<scene::Nearest> nearest = space_.nearest(pose, horizon_m_);
    if (!nearest) return horizon_m_;
    mind(sample, nearest->triangle);
    return nearest->distance_m;
  }

  void mind(Sample& sample, std::uint32_t triangle) {
    if (std::ranges::find(sample.contacts, triangle) != sample.contacts.end()) return;
    finds_contacts_ = true;
    sample.has_rows = false;
    sample.contacts.push_back(triangle);
    if (sample.contacts.size() > kMostContacts) sample.contacts.erase(sample.contacts.begin());
  }

  /// Whether the sample is free at `there`; queries the scene only if the known gap does not
  /// decide. Adds a contact for an obstacle in the way.
  bool is_free(Sample& sample, const StackedPoint& there) {
    if (!meets_rule(sample, there)) {
      breaks_rule_ = true;
      return false;
    }
    if (distance_m(there, sample.known) + sample.floor_m < sample.known_gap_m) return true;
    const double gap_m = this->gap_m(sample, there);
    if (!(gap_m > sample.floor_m)) return false;
    sample.known = there;
    sample.known_gap_m = gap_m;
    return true;
  }

  [[nodiscard]] bool meets_rule(const Sample& sample, const StackedPoint& there) const {
    if (!is_limited(space_.policy())) return true;
    return rule_room(space_.policy(), pose(there), sample.interpolated) >= sample.rule_floor;
  }

  /// Steps towards the constrained minimum as far as the samples stay free, and at most `trust_m`.
  /// Returns the length of the step; nothing at the minimum or if no step is possible; 0 if it must
  /// be repeated with the reduced `trust_m`.
  std::optional<double> take_step(double& trust_m) {
    for (int cut = 0; cut < kMostCuts; ++cut) {
      const StackedPoints whole = solved() - variables_;
      double whole_m = 0.0;
      for (const Sample& sample : samples_) {
        const StackedPoint step = combined(sample.terms, whole);
        whole_m = std::max(whole_m, step.head<3>().norm() + step.tail<4>().norm());
      }
      if (whole_m == 0.0) return std::nullopt;
      finds_contacts_ = false;
      for (; trust_m > kLeastTrust * radius_m_; trust_m *= kDistrust) {
        const double moved_m = std::min(whole_m, trust_m);
        breaks_rule_ = false;
        StackedPoints step = whole_m > trust_m ? StackedPoints(trust_m / whole_m * whole) : whole;
        if (goes(step)) return moved_m;
        if (finds_contacts_) break;
        // The turn violated the orientation policy: retry the step without it.
        if (breaks_rule_) step.rightCols<4>().setZero();
        if (breaks_rule_ && goes(step)) return moved_m;
        if (finds_contacts_) break;
        trust_m = moved_m;
      }
      if (!finds_contacts_) return std::nullopt;
    }
    trust_m *= kDistrust;
    return 0.0;
  }

  bool goes(const StackedPoints& change) {
    bool all_free = true;
    for (Sample& sample : samples_) {
      const StackedPoint there = point(sample) + combined(sample.terms, change);
      all_free = is_free(sample, there) && all_free;
    }
    if (!all_free) return false;
    variables_ += change;
    for (Sample& sample : samples_) sample.has_rows = false;
    return true;
  }

  /// The minimum of the objective subject to the linearised contacts.
  StackedPoints solved() {
    StackedPoints result = form_.minimum();
    if (!may_turn_) result.rightCols<4>() = variables_.rightCols<4>();
    find_bounds();
    const std::span<ForcedBound> bounds = bounds_.bounds();
    if (bounds.empty()) return result;
    find_forces(bounds, unforced(result), replies(), kForceSettled * radius_m_);
    std::map<Eigen::Index, StackedPoint> forces;
    for (const ForcedBound& bound : bounds) {
      if (bound.force == 0.0) continue;
      for (const Term& term : samples_[bound.sample].terms) {
        auto [force, is_new] = forces.try_emplace(term.variable, StackedPoint::Zero());
        force->second += term.share * bound.force * bound.direction;
      }
    }
    for (const auto& [variable, force] : forces) {
      for (Eigen::Index i = 0; i < result.rows(); ++i)
        result.row(i) += form_.inverse()(i, variable) * force.transpose();
    }
    bounds_.remember();
    return result;
  }

  /// The samples at the unconstrained minimum of the objective.
  const StackedPoints& unforced(const StackedPoints& minimum) {
    const auto count = static_cast<Eigen::Index>(samples_.size());
    const Eigen::Index old = unforced_.rows();
    if (old == count) return unforced_;
    unforced_.conservativeResize(count, 7);
    for (Eigen::Index i = old; i < count; ++i)
      unforced_.row(i) = combined(samples_[static_cast<std::size_t>(i)].terms, minimum);
    return unforced_;
  }

  /// The compliance matrix: displacement of each sample per unit force on each.
  const Eigen::MatrixXd& replies() {
    const auto count = static_cast<Eigen::Index>(samples_.size());
    const Eigen::Index known = replies_.cols();
    replies_.conservativeResize(count, count);
    for (Eigen::Index j = known; j < count; ++j) {
      Eigen::VectorXd reply = Eigen::VectorXd::Zero(free_.size());
      for (const Term& term : samples_[static_cast<std::size_t>(j)].terms)
        reply += term.share * form_.inverse().col(term.variable);
      for (Eigen::Index i = 0; i <= j; ++i) {
        double sum = 0.0;
        for (const Term& term : samples_[static_cast<std::size_t>(i)].terms)
          sum += term.share * reply[term.variable];
        replies_(i, j) = replies_(j, i) = sum;
      }
    }
    return replies_;
  }

  void find_bounds() {
    bounds_.clear();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      Sample& sample = samples_[i];
      if (sample.contacts.empty()) continue;
      update_rows(sample);
      const auto place = static_cast<Eigen::Index>(i);
      bounds_.add(i, combined(sample.terms, variables_), replies()(place, place), sample.rows);
    }
  }

  void update_rows(Sample& sample) {
    if (sample.has_rows) return;
    rows_.clear();
    add_contact_rows(space_, may_turn_, problem_.path.reference, lever_m_, point(sample),
                     sample.contacts, horizon_m_ + bounds_.wanted_m(), rows_);
    const std::vector<Contact> before = std::exchange(sample.rows, {});
    for (const ContactRow& row : rows_) {
      const auto same = std::ranges::find_if(before, [&](const Contact& contact) {
        return contact.row.triangle == row.triangle && contact.row.vertex == row.vertex;
      });
      sample.rows.push_back(same == before.end() ? Contact{row, 0.0, 0.0} : *same);
      sample.rows.back().row = row;
    }
    sample.has_rows = true;
  }

  const Problem& problem_;
  FreeSpace& space_;
  const double radius_m_;
  const double lever_m_;
  const bool is_safest_;
  const bool may_turn_;
  ContactBounds bounds_;
  const double horizon_m_;
  const FreeCoefficients free_;
  const SmoothingForm form_;
  StackedPoints variables_;
  std::vector<Sample> samples_;
  StackedPoints unforced_{0, 7};
  Eigen::MatrixXd replies_;
  std::vector<ContactRow> rows_;  ///< buffer
  bool finds_contacts_ = false;
  bool breaks_rule_ = false;
  int& steps_left_;
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

Relaxed proved(const Problem& problem, Relaxation& relaxation, Relaxed free, Ends ends,
               FreeSpace& space, const collision::Deadline& deadline) {
  Offsets better = free.offsets;
  for (int i = 0; i < kRounds && !deadline.passed(); ++i) {
    relaxation.run(deadline);
    better = relaxation.offsets();
    Attempt tried = attempt(problem, {bumps_for(better, ends)}, space, deadline);
    if (tried.candidate) {
      if (!relaxation.is_no_worse(better, free.offsets)) return free;
      return {better, std::move(*tried.candidate)};
    }
    // The path collides between the samples: add samples there.
    relaxation.watch(*tried.collision, free.offsets);
  }
  double share = kRetreat;
  for (int i = 0; i < kRetreats && !deadline.passed(); ++i, share *= kRetreat) {
    const Offsets between = mixed(free.offsets, better, share);
    Attempt tried = attempt(problem, {bumps_for(between, ends)}, space, deadline);
    if (tried.candidate && relaxation.is_no_worse(between, free.offsets))
      return {between, std::move(*tried.candidate)};
  }
  return free;
}

}  // namespace

Relaxed relaxed(const Problem& problem, Relaxed free, Ends ends, Improvement& improvement,
                FreeSpace& space, const collision::Deadline& deadline) {
  int steps_left = std::min(kMostSteps, improvement.steps_left);
  if (steps_left == 0) return free;
  improvement.steps_left -= steps_left;
  Relaxation relaxation(problem, free.offsets, ends, improvement, space, steps_left);
  Relaxed better = proved(problem, relaxation, std::move(free), ends, space, deadline);
  improvement.steps_left += steps_left;
  return better;
}

std::optional<Candidate> polished(const Problem& problem, int knots, Improvement& improvement,
                                  FreeSpace& space, const collision::Deadline& deadline) {
  int steps_left = std::min(kMostSteps, improvement.steps_left);
  if (steps_left == 0) return std::nullopt;
  const Offsets none{problem.knots(knots), 1, {}};
  if (!none.knots.fits()) return std::nullopt;
  const Ends ends = fits_free_ends(problem, none.knots) ? Ends::kFree : Ends::kFixed;
  Relaxation relaxation(problem, none, ends, improvement, space, steps_left);
  if (!relaxation.promises(improvement.worth)) return std::nullopt;
  improvement.steps_left -= steps_left;
  Relaxed better = proved(problem, relaxation, {none, {}}, ends, space, deadline);
  improvement.steps_left += steps_left;
  if (better.candidate.rows.empty()) return std::nullopt;
  return std::move(better.candidate);
}

}  // namespace camway::correction
