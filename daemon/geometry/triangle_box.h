// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Whether the closed triangle and the closed box have a point in common; conservative: false only
/// if a separating axis was proved. An empty box touches nothing.
///
/// Against the axes of the box the test is exact. Against the others, a triangle whose projections
/// are apart by less than `triangle_box_gap_error` counts as touching.
///
/// The 13 axes of Akenine-Möller ("Fast 3D triangle-box overlap testing", 2001). Deviation: every
/// comparison has a margin for its rounding; degenerate triangles need no special case, since an
/// axis that vanishes separates nothing.
bool triangle_touches_box(const Triangle& triangle, const Box& box);

/// How far a computed gap between the projections of triangle and box on `axis` may be from the
/// true one. `scale_m`: no coordinate of either is further from the middle of the box.
double triangle_box_gap_error(const Vec3& axis, double scale_m);

/// Distance between two boxes that are not empty, 0 where they touch; squared. The relative error
/// is at most 8·2^-53 (a difference, a square, two sums).
double squared_box_distance_m2(const Box& a, const Box& b);

}  // namespace camway::geometry
