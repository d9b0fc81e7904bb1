// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "daemon/motion/spline/cubic_path.h"
#include "daemon/motion/spline/knot_row.h"

namespace camway::motion {

/// A cubic B-spline that is added to a path: bump i has its peak, two thirds of its coefficient
/// where knots are equidistant, at knot `first + i` and its support between the knots two before
/// and two after. The sum of equal coefficients is that coefficient. Outside the supports nothing
/// changes, and at their ends value, first and second derivative are zero: the path stays C²,
/// whatever the knots.
struct BumpRow {
  KnotRow knots;
  int first = 0;
  std::vector<CubicPoint> bumps;  ///< coefficients: metres, and differences of images

  [[nodiscard]] double begin_s() const { return knots.knot_s(first - 2); }
  [[nodiscard]] double end_s() const {
    return knots.knot_s(first + static_cast<int>(bumps.size()) + 1);
  }
};

/// Peak of a bump with coefficient 1 on equidistant knots, and its value one knot further.
inline constexpr double kBumpPeak = 2.0 / 3.0;
inline constexpr double kBumpShoulder = 1.0 / 6.0;

/// Value of a bump with coefficient 1 on equidistant knots, `knots` steps from its peak on either
/// side.
double bump_value(double knots);

/// `path` with all `rows` added, split at the knots. Pieces outside the supports are the same bit
/// for bit, and what of a piece that is cut lies outside, but for rounding; pieces share their
/// control point at a join bit for bit. A support may reach beyond the ends of the path, where it
/// is cut off.
CubicPath with_bumps(const CubicPath& path, std::span<const BumpRow> rows);

}  // namespace camway::motion
