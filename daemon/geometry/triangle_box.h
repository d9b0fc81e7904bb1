// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Returns whether the closed triangle and the closed box have a point in common. Returns false
/// only if an axis is proved to separate them. An empty box touches nothing.
///
/// The test of the axes of the box is exact. On another axis, the projections of triangle and box
/// count as touching if they are less than `triangle_box_gap_error` apart.
///
/// Tests the 13 axes of Akenine-Möller ("Fast 3D triangle-box overlap testing", 2001). Deviation:
/// every comparison has a margin for its rounding; degenerate triangles need no special case, since
/// an axis that vanishes separates nothing.
bool triangle_touches_box(const Triangle& triangle, const Box& box);

/// Returns a bound of the error of a computed gap between the projections of triangle and box on
/// `axis`. `scale_m`: bound of the difference of any coordinate of either from the middle of the
/// box.
double triangle_box_gap_error(const Vec3& axis, double scale_m);

/// Returns the squared distance between two boxes, 0 if they touch. Requires that neither is empty.
/// The relative error is at most 8·2^-53 (a difference, a square, two sums).
double squared_box_distance_m2(const Box& a, const Box& b);

}  // namespace camway::geometry
