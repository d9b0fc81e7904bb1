// SPDX-License-Identifier: MIT
#pragma once

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

}  // namespace camway::correction
