// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// A point of the space in which paths are cubic: the position, then the image times a lever arm,
/// so that steps of equal length move the body about equally far. [Units: metres]
using StackedPoint = Eigen::Matrix<double, 7, 1>;
/// One of them in each row.
using StackedPoints = Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>;

inline StackedPoint stacked(const motion::CubicPoint& point, double lever_m) {
  StackedPoint result;
  result << point.position, lever_m * point.image;
  return result;
}
inline motion::CubicPoint unstacked(const StackedPoint& point, double lever_m) {
  return {point.head<3>(), point.tail<4>() / lever_m};
}

/// A share of a variable in something linear.
struct Term {
  Eigen::Index variable;
  double share;
};
using Terms = std::vector<Term>;

/// Whether a row of bumps on these knots can have free ends: what keeps the two keyframes of the
/// gap reaches two knots beyond, and must not reach the keyframes there.
bool fits_free_ends(const Problem& problem, const motion::KnotRow& knots);

/// Which coefficients of a row of bumps a correction is free to choose. With free ends also some
/// before the first keyframe and after the last, as far as they do not reach the next keyframe, so
/// that the path can swing through; those at the two keyframes follow from their neighbours. Other
/// keyframes are kept where free ends fit.
class FreeCoefficients {
 public:
  FreeCoefficients(const Problem& problem, const motion::KnotRow& knots, Ends ends);

  [[nodiscard]] const motion::KnotRow& knots() const { return knots_; }
  [[nodiscard]] int first() const { return first_; }
  [[nodiscard]] int last() const { return last_; }
  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] bool is_held(int k) const {
    return holds_keyframes_ && (k == 0 || k == knots_.count);
  }

  /// Adds `factor` times the coefficient at knot `k` to `terms`; nothing outside the range.
  void add(int k, double factor, Terms& terms) const;
  /// What the row of bumps is at a time, and 0 where it has ended.
  [[nodiscard]] Terms at(double time_s) const;

  [[nodiscard]] StackedPoints variables_of(const Offsets& offsets, double lever_m) const;
  [[nodiscard]] Offsets offsets_of(const StackedPoints& variables, double lever_m) const;

 private:
  [[nodiscard]] Eigen::Index variable(int k) const;

  motion::KnotRow knots_;
  int first_ = 0;
  int last_ = 0;
  bool holds_keyframes_ = false;
  Eigen::Index size_ = 0;
  /// Of the bumps before and after each keyframe, in the one there.
  std::array<std::pair<double, double>, 2> held_shares_;
};

inline StackedPoint combined(const Terms& terms, const StackedPoints& variables) {
  StackedPoint sum = StackedPoint::Zero();
  for (const Term& term : terms) sum += term.share * variables.row(term.variable).transpose();
  return sum;
}

/// Over how much of the gap an offset from the original fades out, for `kClosest`: what bends less
/// goes further astray. [Units: share of the gap]
inline constexpr double kSpread = 1.5;

/// An objective as a sum of squares, linear in the free coefficients (Farin 2002, section 9.4, for
/// bending): distances of control points from the original and their second differences for
/// `kClosest`, and for `kSafest`, which wants gaps besides; first differences, and a little of the
/// second, for `kShortest`; second for `kSmoothest`.
class SmoothingForm {
 public:
  SmoothingForm(const Problem& problem, const FreeCoefficients& free, Objective objective,
                double lever_m, double spread = kSpread);

  [[nodiscard]] double value(const StackedPoints& variables) const;
  /// Where it is least.
  [[nodiscard]] const StackedPoints& minimum() const { return minimum_; }
  /// The inverse of its Hessian, which is the same in all seven dimensions.
  [[nodiscard]] const Eigen::MatrixXd& inverse() const { return inverse_; }

 private:
  void count(double weight, const Terms& terms, const StackedPoint& constant);

  Eigen::MatrixXd hessian_;
  StackedPoints slope_;  ///< at zero
  double at_zero_ = 0.0;
  Eigen::MatrixXd inverse_;
  StackedPoints minimum_;
};

}  // namespace camway::correction
