// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/smoothing/free_coefficients.h"
#include "daemon/correction/smoothing/stacked_point.h"
#include "daemon/correction/smoothing/sum_of_squares.h"

namespace camway::correction {

/// An objective as a quadratic form of the free coefficients.
/// - `kClosest`: D times the cost of `closeness.h`, up to a constant, with the offset's size at its
///   quadratic bound about the offset e of given coefficients: half of
///   ∫ d²/√(|e|² + δ²) + 2·w·D·(d''/a)² dt, where d is the offset from the original, and δ a small
///   share of the largest |e|. Where only positions change and the form falls, the cost falls, up
///   to what δ rounds off (majorisation; Hunter & Lange 2004, "A tutorial on MM algorithms"). A
///   move and a turn at the same time count as the length of both together, the cost adds them.
/// - `kShortest`: half the length of the eye's curve, at its quadratic bound about the velocity v
/// of
///   given coefficients: half of ∫ |c'|²/√(|v|² + δ²) + λ·|c''|² dt. The small second term rounds
///   corners off. The bound is that of `kClosest`.
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
