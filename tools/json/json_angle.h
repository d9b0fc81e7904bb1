// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

namespace camway::tools {

/// Angles are degrees in files and radians in memory.
inline double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

/// Returns the degrees to write for an angle: the rounded quotient or one of its two neighbours,
/// whichever `radians` maps back to the same bits. If none does, the angle that is read is off by a
/// rounding, and writing it again gives the same text.
inline double degrees(double radians_) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double nearest = radians_ * (180.0 / std::numbers::pi);
  for (const double candidate :
       {nearest, std::nextafter(nearest, -kInfinity), std::nextafter(nearest, kInfinity)}) {
    if (radians(candidate) == radians_) return candidate;
  }
  return nearest;
}

}  // namespace camway::tools
