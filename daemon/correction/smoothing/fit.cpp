// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/fit.h"

#include <cmath>

#include <Eigen/Cholesky>

namespace camway::correction {

namespace {

constexpr int kTimesAStep = 6;   // between two knots
constexpr double kSmall = 1e-9;  // decides where a coefficient has no effect on the path

}  // namespace

Offsets fitted(const FreeCoefficients& free, const motion::CubicPath& wanted,
               const motion::CubicPath& base) {
  Eigen::MatrixXd squares = Eigen::MatrixXd::Identity(free.size(), free.size()) * kSmall;
  StackedPoints sums = StackedPoints::Zero(free.size(), 7);
  for (int k = free.first() - 2; k < free.last() + 2; ++k) {
    for (int i = 0; i < kTimesAStep; ++i) {
      const double time_s =
          std::lerp(free.knots().knot_s(k), free.knots().knot_s(k + 1), (i + 0.5) / kTimesAStep);
      if (time_s < base.begin_s() || time_s > base.end_s()) continue;
      const motion::CubicPoint to = wanted.at(time_s);
      const motion::CubicPoint from = base.at(time_s);
      const StackedPoint offset =
          stacked({to.position - from.position, to.image - from.image}, 1.0);
      const Terms terms = free.at(time_s);
      for (const Term& a : terms) {
        sums.row(a.variable) += a.share * offset.transpose();
        for (const Term& b : terms) squares(a.variable, b.variable) += a.share * b.share;
      }
    }
  }
  const StackedPoints variables = squares.ldlt().solve(sums);
  return free.offsets_of(variables, 1.0);
}

}  // namespace camway::correction
