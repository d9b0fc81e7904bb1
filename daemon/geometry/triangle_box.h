// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Whether the closed triangle and the closed box have a point in common. Conservative: false only
/// if a separating axis was proved. An empty box touches nothing.
///
/// The test of the axes of the box is exact. For the other axes, a triangle whose projection is
/// apart by less than `triangle_box_gap_error` counts as touching.
///
/// The 13 axes of Akenine-Möller ("Fast 3D triangle-box overlap testing", 2001). Deviation: every
/// comparison has a margin for its rounding; degenerate triangles need no special case, since an
/// axis that vanishes separates nothing.
bool triangle_touches_box(const Triangle& triangle, const Box& box);

/// Bound of the error of a computed gap between the projections of triangle and box on `axis`.
/// `scale_m`: bound of the difference of any coordinate of either from the middle of the box.
double triangle_box_gap_error(const Vec3& axis, double scale_m);

/// Squared distance between two boxes, 0 where they touch. Requires that neither is empty. The
/// relative error is at most 8·2^-53 (a difference, a square, two sums).
double squared_box_distance_m2(const Box& a, const Box& b);

}  // namespace camway::geometry
