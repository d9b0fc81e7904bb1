// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// A point in the space where paths are cubic: the position, then the image in R⁴ times a lever
/// arm, so that steps of equal length move the body about equally far. [Units: metres]
using StackedPoint = Eigen::Matrix<double, 7, 1>;
/// One stacked point per row.
using StackedPoints = Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>;

inline StackedPoint stacked(const motion::CubicPoint& point, double lever_m) {
  StackedPoint result;
  result << point.position, lever_m * point.image;
  return result;
}
inline motion::CubicPoint unstacked(const StackedPoint& point, double lever_m) {
  return {point.head<3>(), point.tail<4>() / lever_m};
}

/// A term of a linear combination of variables.
struct Term {
  Eigen::Index variable;
  double share;
};
/// Terms of a point of a row of bumps: four bumps reach it, and each may be held by two others.
using Terms = boost::container::static_vector<Term, 8>;

/// Whether a row of bumps on `knots` can have free ends. The bumps that keep the two keyframes of
/// the interval reach two knots beyond them, and must not reach the next keyframes.
bool fits_free_ends(const Problem& problem, const motion::KnotRow& knots);

/// The coefficients of a row of bumps that a correction may choose. With fixed ends they are those
/// whose supports lie within the row. With free ends they include some before the first and after
/// the last keyframe of the interval, as far as those do not reach the next keyframe, so that the
/// path may change its slope at the two keyframes. The coefficients at keyframes are *held*: they
/// follow from their neighbours, so that the keyframe is kept. Requires every keyframe within the
/// supports to be at a knot, with no keyframe at the next knot; with free ends that holds for other
/// keyframes than the two where free ends fit (`fits_free_ends`).
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

  /// Adds `factor` times the coefficient at knot `k` to `terms`; nothing outside of the range.
  void add(int k, double factor, Terms& terms) const;
  /// Value of the row of bumps at a time; empty outside of the supports.
  [[nodiscard]] Terms at(double time_s) const;
  /// The bump at knot `k`. [Limit: first() <= k <= last()]
  [[nodiscard]] const motion::KnotBump& bump(int k) const {
    return bumps_[static_cast<std::size_t>(k - first_)];
  }

  [[nodiscard]] StackedPoints variables_of(const Offsets& offsets, double lever_m) const;
  [[nodiscard]] Offsets offsets_of(const StackedPoints& variables, double lever_m) const;

 private:
  [[nodiscard]] Eigen::Index variable(int k) const;

  /// A keyframe's knot, and the shares of the coefficients before and after it in its own.
  struct Held {
    int knot;
    double of_before;
    double of_after;
  };
  void hold(int knot);

  motion::KnotRow knots_;
  std::vector<motion::KnotBump> bumps_;  ///< from `first_` to `last_`
  int first_ = 0;
  int last_ = 0;
  Eigen::Index size_ = 0;
  std::vector<Held> held_;
};

inline StackedPoint combined(const Terms& terms, const StackedPoints& variables) {
  StackedPoint sum = StackedPoint::Zero();
  for (const Term& term : terms) sum += term.share * variables.row(term.variable).transpose();
  return sum;
}

/// An objective as a quadratic form of the free coefficients.
/// - `kClosest`: D times the cost of `closeness.h`, up to a constant, with the offset's size at its
///   quadratic bound about the offset e of given coefficients: half of
///   ∫ d²/√(|e|² + δ²) + 2·w·D·(d''/a)² dt, where d is the offset from the original, and δ a small
///   share of the largest |e|. Where only positions change and the form falls, the cost falls, up
///   to what δ rounds off (majorisation; Hunter & Lange 2004, "A tutorial on MM algorithms"). A
///   move and a turn at the same time count as the length of both together, the cost adds them.
///
/// The others are weighted sums of squares (Farin 2002, section 9.4, for bending) of control
/// points' distances from the original and of the first and second differences of the path's
/// control points. They require equidistant knots.
/// - `kSafest`: distances and second differences; it also wants gaps, which are not part of the
///   form.
/// - `kShortest`: first differences, and second differences with a small weight.
/// - `kSmoothest`: second differences.
class SmoothingForm {
 public:
  /// `closeness` and `about`, the coefficients whose offset is e, count for `kClosest` only.
  SmoothingForm(const Problem& problem, const FreeCoefficients& free, Objective objective,
                double lever_m, const Closeness& closeness, const StackedPoints& about);

  /// Makes the form the bound about other coefficients, unless they are the same. Requires the
  /// objective `kClosest`.
  void bound_about(const StackedPoints& about);

  [[nodiscard]] double value(const StackedPoints& variables) const;
  /// The minimiser.
  [[nodiscard]] const StackedPoints& minimum() const { return minimum_; }
  /// The inverse of the Hessian, which is the same in all seven dimensions.
  [[nodiscard]] const Eigen::MatrixXd& inverse() const { return inverse_; }

 private:
  void count_differences(const Problem& problem, const FreeCoefficients& free, Objective objective,
                         double lever_m);
  void find_places(const Problem& problem, const FreeCoefficients& free, double lever_m);
  void count(double weight, const Terms& terms, const StackedPoint& constant);
  void solve();

  /// A place of Gauss's rule: the offset from the original there, as a function of the
  /// coefficients.
  struct OffsetPlace {
    double share_s;  ///< weight in the integral
    Terms value;
    Terms bent;            ///< second derivative
    StackedPoint offset;   ///< of the problem's path
    StackedPoint bending;  ///< its second derivative
  };

  std::vector<OffsetPlace> places_;        ///< for `kClosest`
  double bend_weight_ = 0.0;               ///< of squared second derivatives, for `kClosest`
  std::optional<StackedPoints> bound_at_;  ///< coefficients about which the form is, for `kClosest`
  Eigen::MatrixXd hessian_;
  StackedPoints slope_;  ///< gradient at zero
  double at_zero_ = 0.0;
  Eigen::MatrixXd inverse_;
  StackedPoints minimum_;
};

}  // namespace camway::correction
