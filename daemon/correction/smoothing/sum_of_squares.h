// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "daemon/correction/smoothing/stacked_point.h"

namespace camway::correction {

/// Variables on which one stacked point depends are at most so many apart: four bumps reach a time,
/// and a held coefficient follows from the two beside it (`FreeCoefficients`).
inline constexpr Eigen::Index kBand = 3;

/// The lower half of a symmetric band matrix: row i has the elements (i, i), (i, i - 1), ...,
/// (i, i - kBand).
using BandMatrix = Eigen::Matrix<double, Eigen::Dynamic, kBand + 1, Eigen::RowMajor>;

/// Cholesky factors of a positive definite band matrix (Golub & Van Loan 2013, section 4.3.5). They
/// are banded as well, so a solution takes linear time.
class BandFactors {
 public:
  explicit BandFactors(const BandMatrix& matrix);

  /// Number of rows of the matrix.
  [[nodiscard]] Eigen::Index size() const { return factors_.rows(); }

  /// Replaces right-hand sides, one in each column, by the solutions. Requires as many rows as the
  /// matrix has.
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

/// Half a weighted sum of squares of stacked points that depend linearly on variables.
struct SumOfSquares {
  explicit SumOfSquares(Eigen::Index variables)
      : hessian(BandMatrix::Zero(variables, kBand + 1)), slope(StackedPoints::Zero(variables, 7)) {}

  /// Adds half of `weight` times the square of the point `constant` plus `terms`. Requires
  /// variables that are at most `kBand` apart.
  void count(double weight, const Terms& terms, const StackedPoint& constant);
  [[nodiscard]] double value(const StackedPoints& variables) const;

  BandMatrix hessian;   ///< the same in all seven dimensions
  StackedPoints slope;  ///< gradient at zero
  double at_zero = 0.0;
};

}  // namespace camway::correction
