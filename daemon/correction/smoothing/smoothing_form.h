// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/guide.h"
#include "daemon/correction/smoothing/stacked_point.h"
#include "daemon/correction/smoothing/sum_of_squares.h"

namespace camway::correction {

/// Returns whether a row of bumps on `knots` can have free ends. The bumps that keep the two
/// keyframes of the interval reach two knots beyond these keyframes; they must not reach the next
/// keyframes.
bool fits_free_ends(const Problem& problem, const motion::KnotRow& knots);

/// The coefficients of a row of bumps that a correction may choose. With fixed ends they are those
/// of the bumps whose supports lie within the row. With free ends they also include bumps before
/// the first and after the last keyframe of the interval, as far as these do not reach the next
/// keyframe. So the path may change its slope at the two keyframes. The coefficient at a keyframe
/// is *held*: it follows from its two neighbours so that the keyframe is kept. Requires every
/// keyframe within the supports to be at a knot, with no keyframe at the next knot; with free ends
/// that holds for other keyframes than the two where free ends fit (`fits_free_ends`).
class FreeCoefficients {
 public:
  FreeCoefficients(const Problem& problem, const motion::KnotRow& knots, Ends ends);

  [[nodiscard]] const motion::KnotRow& knots() const { return knots_; }
  [[nodiscard]] int first() const { return first_; }
  [[nodiscard]] int last() const { return last_; }
  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] bool is_held(int k) const {
    return std::ranges::find(held_, k, &Held::knot) != held_.end();
  }

  /// Adds `factor` times the coefficient at knot `k` to `terms`, and nothing if `k` is outside of
  /// [first(), last()].
  void add(int k, double factor, Terms& terms) const;
  /// Returns the value of the row of bumps at a time; no terms outside of the supports.
  [[nodiscard]] Terms at(double time_s) const;
  /// Returns the bump at knot `k`. [Limit: first() <= k <= last()]
  [[nodiscard]] const motion::KnotBump& bump(int k) const {
    return bumps_[static_cast<std::size_t>(k - first_)];
  }

  [[nodiscard]] StackedPoints variables_of(const Offsets& offsets, double lever_m) const;
  [[nodiscard]] Offsets offsets_of(const StackedPoints& variables, double lever_m) const;

 private:
  static constexpr Eigen::Index kNoVariable = -1;

  /// The variable of the coefficient at knot `k`; kNoVariable if that is held.
  [[nodiscard]] Eigen::Index variable(int k) const {
    return variables_[static_cast<std::size_t>(k - first_)];
  }

  /// The knot of a keyframe. Its coefficient is `of_before` times the one before, plus `of_after`
  /// times the one after.
  struct Held {
    int knot;
    double of_before;
    double of_after;
  };
  void hold(int knot);

  motion::KnotRow knots_;
  std::vector<motion::KnotBump> bumps_;  ///< from `first_` to `last_`
  std::vector<Eigen::Index> variables_;  ///< of these knots, by `variable`
  int first_ = 0;
  int last_ = 0;
  Eigen::Index size_ = 0;
  std::vector<Held> held_;
};

/// An objective as a quadratic form of the free coefficients.
/// - `kClosest`: D times the cost of `closeness.h`, up to a constant, with the offset's size at its
///   quadratic bound about the offset e of given coefficients: half of
///   ∫ d²/√(|e|² + δ²) + 2·w·D·(d''/a)² dt, where d is the offset from the original, and δ a small
///   share of the largest |e|. Where only positions change and the form falls, the cost falls, up
///   to what δ rounds off (majorisation; Hunter & Lange 2004, "A tutorial on MM algorithms"). A
///   move and a turn at the same time count as the length of both together, the cost adds them.
///
/// - `kShortest`: half the length of the eye's curve, at its quadratic bound about the velocity v
/// of
///   given coefficients, with a small weight of bending that rounds corners off: half of
///   ∫ |c'|²/√(|v|² + δ²) + λ·|c''|² dt. The bound is that of `kClosest`.
/// - `kSmoothest`: half the bending energy of the eye's curve, ∫ |c''|² dt.
/// - `kSafest`: half the weighted sum of squares of the control points' distances from the original
///   and of the second differences of the path's control points (Farin 2002, section 9.4). Its gaps
///   are not part of the form (`ContactBounds`). Requires equidistant knots.
///
/// The integrals of `kShortest` and `kSmoothest` are about positions alone.
class SmoothingForm {
 public:
  /// `about`: the coefficients whose offset is e, or whose velocity is v; without effect for
  /// others. Only `kClosest` uses `closeness`.
  SmoothingForm(const Problem& problem, const FreeCoefficients& free, Objective objective,
                double lever_m, const Closeness& closeness, const StackedPoints& about);

  /// Replaces the form by the quadratic bound about the coefficients `about`. Requires the
  /// objective `kClosest` or `kShortest`.
  void bound_about(const StackedPoints& about);

  /// Returns the value of the form.
  [[nodiscard]] double value(const StackedPoints& variables) const {
    return squares_.value(variables);
  }
  /// Returns the value of what the form bounds, up to a constant for `kClosest`; the value of the
  /// form where that is no bound.
  [[nodiscard]] double bounded_value(const StackedPoints& variables) const;
  /// Returns the coefficients that minimise the form.
  [[nodiscard]] const StackedPoints& minimum() const { return minimum_; }
  /// Returns the factors of the Hessian, which is the same in all seven dimensions.
  [[nodiscard]] const BandFactors& factors() const { return *factors_; }

 private:
  void find_places(const Problem& problem, const FreeCoefficients& free, double lever_m,
                   double bend_weight);
  void find_velocities(const Problem& problem, const FreeCoefficients& free, double lever_m);
  void count_bending(const Problem& problem, const FreeCoefficients& free, double weight);
  void count_differences(const Problem& problem, const FreeCoefficients& free, double lever_m);
  void solve();

  /// A place of Gauss's rule: the vector whose length is integrated there, as a function of the
  /// coefficients. It is the offset from the original, or the velocity.
  struct Place {
    double share_s;  ///< weight in the integral
    Terms value;
    StackedPoint constant;  ///< of the problem's path
  };

  std::vector<Place> places_;              ///< for `kClosest` and `kShortest`
  SumOfSquares bending_;                   ///< of second derivatives, for all but `kSafest`
  std::optional<StackedPoints> bound_at_;  ///< `about` of the present form, if it is a bound
  SumOfSquares squares_;                   ///< the form
  std::optional<BandFactors> factors_;     ///< of the form
  StackedPoints minimum_;
};

}  // namespace camway::correction
