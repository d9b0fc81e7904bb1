// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Half the distance from 1 to the next double, 2^-53. A correctly rounded +, -, *, / or sqrt has a
/// relative error of at most this (Higham 2002, "Accuracy and Stability of Numerical Algorithms",
/// section 2.2), and an absolute error of at most `kSmallestNormal` where the result underflows.
inline constexpr double kUnitRoundoff = 0x1p-53;

/// Added to bounds, so that an underflow of a product never counts as a proof.
inline constexpr double kSmallestNormal = 0x1p-1022;

/// Largest coordinate that kernels accept: differences, and products of three of them, do not
/// overflow. It is far beyond any scene; import refuses larger ones.
inline constexpr double kLargestCoordinate_m = 0x1p200;

/// Returns the nearest number in [0, 1]; 0 for NaN.
constexpr double clamp_to_unit(double x) { return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0; }

/// Returns a length of `v` that is never below the true one, and above it by few roundings. Scales
/// by the largest coordinate, so that squares neither overflow nor vanish.
inline double length_above(const Vec3& v) {
  const double scale = v.lpNorm<Eigen::Infinity>();
  if (scale == 0.0) return 0.0;
  // Three quotients, three squares, two sums, a root and a product are fewer than 8 roundings in
  // sequence.
  constexpr double kRounding = 8.0 * kUnitRoundoff;
  return scale * (v / scale).norm() * (1.0 + 2.0 * kRounding) + kSmallestNormal;
}

}  // namespace camway::geometry
