// SPDX-License-Identifier: MIT
#pragma once

namespace camway::geometry {

/// Half the distance from 1 to the next double, 2^-53: a correctly rounded +, -, *, / or sqrt has a
/// relative error of at most this (Higham 2002, "Accuracy and Stability of Numerical Algorithms",
/// section 2.2), and of at most `kSmallestNormal` absolutely where the result underflows.
inline constexpr double kUnitRoundoff = 0x1p-53;

/// Added to bounds, so that an underflow of a product can never be taken for a proof.
inline constexpr double kSmallestNormal = 0x1p-1022;

/// Kernels accept coordinates up to this magnitude: differences, and products of three of them, do
/// not overflow. It is far beyond any scene; import refuses what passes it.
inline constexpr double kLargestCoordinate_m = 0x1p200;

}  // namespace camway::geometry
