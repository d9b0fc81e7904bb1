// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <Eigen/Core>

namespace camway::tools {

/// Farthest that the products of a rotation's columns may be from those of unit vectors at right
/// angles. Programs that multiply rotations in single precision are off by less.
inline constexpr double kRotationSlack = 1e-3;

/// Returns the same for numbers that are written with so many digits: what rounding adds. A matrix
/// with one digit is allowed 0.05.
double rotation_slack(int digits);

/// Returns what is wrong with a rotation: "is no rotation: it mirrors". Empty if its columns are at
/// right angles, of length 1, and right-handed.
std::string rotation_fault(const Eigen::Matrix3d& matrix, double slack = kRotationSlack);

/// Returns what is wrong with the product of a rotation and a scale for each axis; empty if nothing
/// is. If so, divides its columns by their lengths.
std::string take_scale(Eigen::Matrix3d& matrix);

}  // namespace camway::tools
