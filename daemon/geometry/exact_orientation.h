// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::geometry {

using Vec2 = Eigen::Vector2d;

/// Sign of the area of the triangle `a`, `b`, `c`, exactly: 1 if they turn counter-clockwise, -1 if
/// clockwise, 0 if they lie on one line. Doubles decide it where they can (the error bounds are of
/// the kind of Shewchuk 1997, "Adaptive precision floating-point arithmetic", section 4), rational
/// numbers otherwise. Precondition: every coordinate is finite and below kLargestCoordinate_m.
int orientation(const Vec2& a, const Vec2& b, const Vec2& c);

/// Sign of `((b - a) × (c - a)) · (p - a)`, exactly: 1 if `p` is on the side from which `a`, `b`,
/// `c` are seen counter-clockwise, -1 on the other, 0 in their plane. Same precondition.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);

}  // namespace camway::geometry
