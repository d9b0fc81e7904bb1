// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include "daemon/motion/spline/cubic_path.h"

namespace camway::correction {

/// A point of a path in the space in which paths are cubic splines: the position, then the image in
/// R⁴ times a lever arm. The lever arm makes steps of equal length move the body about equally far.
/// [Units: metres]
using StackedPoint = Eigen::Matrix<double, 7, 1>;
/// Stacked points, one per row.
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
  Eigen::Index variable;  ///< row of the variable in `StackedPoints`
  double share;           ///< its factor
};
/// The value of a row of bumps at a time, in terms of the variables. Four bumps reach a time, and
/// the coefficient of each may follow from two variables.
using Terms = boost::container::static_vector<Term, 8>;

inline StackedPoint combined(const Terms& terms, const StackedPoints& variables) {
  StackedPoint sum = StackedPoint::Zero();
  for (const Term& term : terms) sum += term.share * variables.row(term.variable).transpose();
  return sum;
}

/// The lower half of a symmetric band matrix: in row i, the elements (i, i), (i, i - 1), ... up to
/// `kBand` beside the diagonal.
inline constexpr Eigen::Index kBand = 3;
using BandMatrix = Eigen::Matrix<double, Eigen::Dynamic, kBand + 1, Eigen::RowMajor>;

/// Cholesky factors of a positive definite band matrix (Golub & Van Loan 2013, section 4.3.5).
class BandFactors {
 public:
  explicit BandFactors(const BandMatrix& matrix);

  /// Replaces the right-hand sides, one in each column, by the solutions.
  template <class RightHandSides>
  void solve_in_place(RightHandSides& sides) const {
    const Eigen::Index count = factors_.rows();
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index d = 1; d <= std::min(i, kBand); ++d) {
        sides.row(i) -= factors_(i, d) * sides.row(i - d);
      }
      sides.row(i) *= of_diagonal_[i];
    }
    for (Eigen::Index i = count; i-- > 0;) {
      for (Eigen::Index d = 1; d <= std::min(count - 1 - i, kBand); ++d) {
        sides.row(i) -= factors_(i + d, d) * sides.row(i + d);
      }
      sides.row(i) *= of_diagonal_[i];
    }
  }

 private:
  BandMatrix factors_;
  Eigen::VectorXd of_diagonal_;  ///< reciprocals of the diagonal
};

/// Half a weighted sum of squares of stacked points that depend linearly on variables. Variables of
/// one point are at most `kBand` apart.
struct SumOfSquares {
  explicit SumOfSquares(Eigen::Index variables)
      : hessian(BandMatrix::Zero(variables, kBand + 1)), slope(StackedPoints::Zero(variables, 7)) {}

  /// Adds half of `weight` times the square of the point `constant` plus `terms`.
  void count(double weight, const Terms& terms, const StackedPoint& constant);
  [[nodiscard]] double value(const StackedPoints& variables) const;

  BandMatrix hessian;   ///< the same in all seven dimensions
  StackedPoints slope;  ///< gradient at zero
  double at_zero = 0.0;
};

}  // namespace camway::correction
