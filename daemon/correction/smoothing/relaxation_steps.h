// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/budget.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/guide.h"
#include "daemon/correction/smoothing/constrained_minimum.h"
#include "daemon/correction/smoothing/free_coefficients.h"
#include "daemon/correction/smoothing/improvement.h"
#include "daemon/correction/smoothing/path_sample.h"
#include "daemon/correction/smoothing/relaxation.h"
#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// Share of the way back to a free correction on which a relaxed one is tried next. Chosen by
/// measurement.
inline constexpr double kRetreat = 0.6;

/// The steps of a relaxation (`relaxation.h`). They keep the path free at samples, and prove
/// nothing between these. Refers to `problem` and `space`, which must outlive it.
class Relaxation {
 public:
  Relaxation(const Problem& problem, const Offsets& offsets, Ends ends,
             const Improvement& improvement, FreeSpace& space);

  [[nodiscard]] Offsets offsets() const { return free_.offsets_of(variables_, lever_m_); }

  /// Whether the objective may fall by `share`, subject to the known contacts.
  [[nodiscard]] bool promises(double share);

  /// Avoiding obstacles may cost more than the other terms gain, and room has its price. Always
  /// true for `kSafest`, which gains gaps that the form does not contain.
  [[nodiscard]] bool is_no_worse(const Relaxed& now, const Relaxed& before) const;

  /// The share of the way from `before` to `now` that is tried first if `now` is too dear. The cost
  /// is convex, so on this share of the way it has grown by no more than room may cost.
  [[nodiscard]] double first_share(const Relaxed& now, const Relaxed& before) const;

  /// The share of the way from `found` to the dearer `wider` that may cost half of what is left of
  /// the price of room. The cost is convex.
  [[nodiscard]] double affordable_share(const Relaxed& wider, const Relaxed& found,
                                        const Relaxed& before) const;

  /// The largest length of the first step. [Units: metres]
  [[nodiscard]] double first_trust_m() const;

  /// Takes steps until the budget is spent, or a step gains little.
  void run(base::Budget& budget, const base::Deadline& deadline);
  /// The same with `trust_m` as the largest length of the next step, which is adapted.
  void run(base::Budget& budget, double& trust_m, const base::Deadline& deadline);

  /// Adds samples in `collision` and moves the path back towards `free`, by as much as makes all
  /// samples free.
  void watch(const collision::CollisionInterval& collision, const Offsets& free);

  /// Where the path passes the scene with next to no gap, if the relaxation makes room: the least
  /// gap lies between two samples.
  [[nodiscard]] std::optional<collision::CollisionInterval> tight_place(
      const Candidate& candidate, const base::Deadline& deadline) const;

  /// Adds samples in `range`, where the path is free.
  void look_closer(const collision::CollisionInterval& range);

 private:
  [[nodiscard]] double cost(const Relaxed& correction) const;

  /// Makes a form that bounds its objective touch it at the path as it is.
  void bound_cost();

  /// The largest growth of the cost that is accepted, for `kClosest`.
  [[nodiscard]] double most_growth() const;

  void add_sample(double time_s);

  /// Adds samples that are known to be free for the variables `known`, with their contacts.
  void add_samples_in(const collision::CollisionInterval& range, const StackedPoints& known);

  void add_samples(const Problem& problem, double begin_s, double end_s);

  /// `kSafest` may reduce gaps, but none below the least gap of the whole path.
  void keep_least_gap();

  void take_back(const StackedPoints& known, double time_s);

  /// Whether all samples are free that `count` variables from `low` on move.
  [[nodiscard]] bool all_free_with(Eigen::Index low, Eigen::Index count);

  /// Steps towards the constrained minimum as far as the samples stay free, and at most `trust_m`.
  /// Returns the length of the step; nothing at the minimum or if no step is possible; 0 if it must
  /// be repeated with the reduced `trust_m`.
  std::optional<double> take_step(double& trust_m);

  /// The largest distance that a change of the variables moves a sample.
  [[nodiscard]] double length_m(const StackedPoints& change) const;

  /// Adds `change` to the variables if all samples stay free.
  SampleCheck try_step(const StackedPoints& change);

  /// The minimum of the objective subject to the linearised contacts.
  StackedPoints minimum(Convergence convergence = Convergence::kUsual);

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

}  // namespace camway::correction
