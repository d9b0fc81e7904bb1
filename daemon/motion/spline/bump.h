// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "daemon/motion/spline/cubic_path.h"
#include "daemon/motion/spline/knot_row.h"

namespace camway::motion {

/// A row of cubic B-splines that is added to a path. Bump i has its peak at knot `first + i` (two
/// thirds of its coefficient where knots are equidistant) and its support between the knots two
/// before and two after. The sum of equal coefficients is that coefficient. Outside the supports
/// nothing changes, and at their ends value, first and second derivative are zero, so the path
/// stays C², whatever the knots.
struct BumpRow {
  KnotRow knots;
  int first = 0;
  std::vector<CubicPoint> bumps;  ///< coefficients: metres, and differences of images

  [[nodiscard]] double begin_s() const { return knots.knot_s(first - 2); }
  [[nodiscard]] double end_s() const {
    return knots.knot_s(first + static_cast<int>(bumps.size()) + 1);
  }
};

/// Peak of a bump with coefficient 1 on equidistant knots.
inline constexpr double kBumpPeak = 2.0 / 3.0;

/// Returns `path` with all `rows` added, split at their knots. Pieces outside the supports are the
/// same bit for bit; the parts of a split piece outside the supports are the same up to rounding.
/// Pieces share their control point at a join bit for bit. A support may reach beyond the ends of
/// the path, where it is cut off.
CubicPath with_bumps(const CubicPath& path, std::span<const BumpRow> rows);

}  // namespace camway::motion
