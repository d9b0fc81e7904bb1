// SPDX-License-Identifier: MIT
#pragma once

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

}  // namespace camway::geometry
