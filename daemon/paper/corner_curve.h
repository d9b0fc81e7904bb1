// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "daemon/motion/path/segment.h"

namespace camway::paper {

/// A rational Bézier curve of degree 15: control points `(w·x, w·y, w·z, w)`.
struct RationalCurve {
  std::array<geometry::Vec4, 16> homogeneous;

  /// Requires that the weight is not zero at `u`.
  [[nodiscard]] geometry::Vec3 point_at(double u) const;
};

/// The exact curve `P(t) + R(q(t))·corner_C` of a point fixed to the camera on `segment`. With W =
/// |Q|² and N = Q·c·Q̄, both of degree 12, it is (P·W + N)/W: degree 15 over degree 12, all
/// elevated to 15.
///
/// Deviation from Johnstone & Williams, "A rational model of the surface swept by a curve" (1995):
/// their programs stay at degree 12 by adding position points, elevated as a polynomial, to the
/// points N_j/W_j of the rational rotation. That is a different curve wherever weights vary; it
/// misses the true one by a centimetre on metre-sized steps (the tests measure it).
RationalCurve corner_curve(const motion::Segment& segment, const geometry::Vec3& corner_C);

}  // namespace camway::paper
