// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/sum_of_squares.h"

#include <cassert>
#include <cmath>

namespace camway::correction {

BandFactors::BandFactors(const BandMatrix& matrix) : factors_(matrix), of_diagonal_(matrix.rows()) {
  for (Eigen::Index i = 0; i < factors_.rows(); ++i) {
    double squared = factors_(i, 0);
    for (Eigen::Index j = std::max<Eigen::Index>(0, i - kBand); j < i; ++j) {
      double element = factors_(i, i - j);
      for (Eigen::Index k = std::max<Eigen::Index>(0, i - kBand); k < j; ++k) {
        if (j - k <= kBand) element -= factors_(i, i - k) * factors_(j, j - k);
      }
      element *= of_diagonal_[j];
      factors_(i, i - j) = element;
      squared -= element * element;
    }
    of_diagonal_[i] = 1.0 / std::sqrt(squared);
  }
}

void SumOfSquares::count(double weight, const Terms& terms, const StackedPoint& constant) {
  at_zero += 0.5 * weight * constant.squaredNorm();
  for (const Term& a : terms) {
    slope.row(a.variable) += weight * a.share * constant.transpose();
    for (const Term& b : terms) {
      assert(std::abs(a.variable - b.variable) <= kBand);
      if (b.variable > a.variable) continue;
      hessian(a.variable, a.variable - b.variable) += weight * a.share * b.share;
    }
  }
}

double SumOfSquares::value(const StackedPoints& variables) const {
  double sum = at_zero + slope.cwiseProduct(variables).sum();
  for (Eigen::Index i = 0; i < variables.rows(); ++i) {
    StackedPoint row = 0.5 * hessian(i, 0) * variables.row(i).transpose();
    for (Eigen::Index d = 1; d <= std::min(i, kBand); ++d) {
      row += hessian(i, d) * variables.row(i - d).transpose();
    }
    sum += variables.row(i).dot(row);
  }
  return sum;
}

}  // namespace camway::correction
