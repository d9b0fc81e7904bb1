// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

namespace camway::tools {

/// Angles are degrees in files and radians in memory.
inline double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

/// The degrees to write for an angle: of the doubles next to the quotient one that reads back as
/// the same bits, if there is one. Otherwise what is read is off by a rounding, and written again
/// it is the same text.
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
