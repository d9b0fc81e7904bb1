// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::geometry {

using Vec2 = Eigen::Vector2d;

/// Sign of the area of the triangle `a`, `b`, `c`, exactly: 1 if counter-clockwise, -1 if
/// clockwise, 0 if the points lie on one line. Decided in doubles where possible (with error bounds
/// of the kind of Shewchuk 1997, "Adaptive precision floating-point arithmetic", section 4),
/// otherwise in rational numbers. Requires every coordinate to be finite and below
/// kLargestCoordinate_m.
int orientation(const Vec2& a, const Vec2& b, const Vec2& c);

/// Sign of `((b - a) × (c - a)) · (p - a)`, exactly: 1 if `p` is on the side from which `a`, `b`,
/// `c` are seen counter-clockwise, -1 on the other side, 0 in their plane. Requires every
/// coordinate to be finite and below kLargestCoordinate_m.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);

}  // namespace camway::geometry
