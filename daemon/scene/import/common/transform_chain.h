// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>

namespace camway::scene::import_process {

/// Half the distance from 1 to the next float.
inline constexpr double kFloatRoundoff =
    static_cast<double>(std::numeric_limits<float>::epsilon()) / 2.0;

/// Error of a number that a library only reads, in roundoffs of a float: it makes a decimal of
/// whole part and fraction, each rounded, and their sum, and multiplies by a power of ten, rounded
/// too.
inline constexpr double kReadingRoundoffs = 8.0;

/// The magnitudes of a 4 × 4 matrix that multiplies points as columns: its last column moves.
using Magnitudes = std::array<std::array<double, 4>, 4>;

/// Bounds the rounding of a chain of transforms in single precision. A chain of m products of 4
/// terms, the last with a vertex, is off by less than 4 m roundoffs, and a few of reading, of the
/// same chain of magnitudes (Higham 2002, "Accuracy and Stability of Numerical Algorithms",
/// section 3.5); doubled, which is more than the terms of higher order come to.
class TransformChain {
 public:
  TransformChain();
  /// This chain with one more transform, which is applied to points first. `products`: matrices
  /// whose product it is.
  [[nodiscard]] TransformChain then(const Magnitudes& inner, double products = 1.0) const;
  /// This chain after a step that is known by its result alone: the matrix of the whole chain.
  [[nodiscard]] TransformChain at_least(const Magnitudes& whole, double products) const;

  /// Bound of the rounding of a transformed point whose coordinates are at most `largest`; 0 for an
  /// empty chain.
  [[nodiscard]] double rounding(const std::array<double, 3>& largest) const;

 private:
  Magnitudes chain_{};
  double products_ = 0.0;
};

}  // namespace camway::scene::import_process
