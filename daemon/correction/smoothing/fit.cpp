// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/fit.h"

#include <cmath>

namespace camway::correction {

namespace {

constexpr int kTimesAStep = 4;   // between two knots
constexpr double kSmall = 1e-9;  // decides where a coefficient has no effect on the path

}  // namespace

Offsets fitted(const FreeCoefficients& free, const motion::CubicPath& wanted,
               const motion::CubicPath& base) {
  SumOfSquares squares(free.size());
  squares.hessian.col(0).setConstant(kSmall);
  for (int k = free.first() - 2; k < free.last() + 2; ++k) {
    for (int i = 0; i < kTimesAStep; ++i) {
      const double time_s =
          std::lerp(free.knots().knot_s(k), free.knots().knot_s(k + 1), (i + 0.5) / kTimesAStep);
      if (time_s < base.begin_s() || time_s > base.end_s()) continue;
      const motion::CubicPoint to = wanted.at(time_s);
      const motion::CubicPoint from = base.at(time_s);
      const StackedPoint offset =
          stacked({to.position - from.position, to.image - from.image}, 1.0);
      squares.count(1.0, free.at(time_s), -offset);
    }
  }
  StackedPoints variables = -squares.slope;
  BandFactors(squares.hessian).solve_in_place(variables);
  return free.offsets_of(variables, 1.0);
}

}  // namespace camway::correction
