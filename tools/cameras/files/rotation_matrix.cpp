// SPDX-License-Identifier: MIT
#include "tools/cameras/files/rotation_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace camway::tools {
namespace {

/// Requires columns of length 1.
std::string angles_fault(const Eigen::Matrix3d& matrix, double slack) {
  const Eigen::Matrix3d products = matrix.transpose() * matrix;
  const double off =
      std::max({std::abs(products(0, 1)), std::abs(products(0, 2)), std::abs(products(1, 2))});
  if (off > slack) return "is no rotation: its columns are not at right angles";
  return matrix.determinant() > 0.0 ? "" : "is no rotation: it mirrors";
}

}  // namespace

double rotation_slack(int digits) {
  constexpr double kRoughest = 0.05;
  // Half a unit of the last digit in each number, in two columns of length 1.
  const double rounding = std::sqrt(3.0) * std::pow(10.0, -digits);
  return std::min(kRoughest, kRotationSlack + rounding);
}

std::string rotation_fault(const Eigen::Matrix3d& matrix, double slack) {
  const Eigen::RowVector3d lengths = matrix.colwise().norm();
  // A square is off by twice as much as its root.
  if (!((lengths.array() - 1.0).abs().maxCoeff() <= 0.5 * slack)) {
    return fmt::format("is no rotation: its columns have the lengths {:.4g}, {:.4g} and {:.4g}",
                       lengths[0], lengths[1], lengths[2]);
  }
  return angles_fault(matrix, slack);
}

std::string take_scale(Eigen::Matrix3d& matrix) {
  const Eigen::RowVector3d lengths = matrix.colwise().norm();
  if (!(lengths.minCoeff() > 0.0) || !lengths.allFinite()) {
    return "has no rotation: an axis has no length";
  }
  for (Eigen::Index k = 0; k < 3; ++k) matrix.col(k) /= lengths[k];
  return angles_fault(matrix, kRotationSlack);
}

}  // namespace camway::tools
