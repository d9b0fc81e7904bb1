// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// The point of the convex hull of `points` that is closest to the origin (Wolfe, "Finding the
/// nearest point in a polytope", Mathematical Programming 11, 1976). It is unique, so independent
/// of the frame and of the order of the points up to rounding. The iteration ends when no point
/// could lower the squared length by more than `kMinNormGap`; the result is then within the square
/// root of `kMinNormGap` of the true point.
///
/// Deviations: the affine sub-problem is solved by a pivoted QR decomposition of the differences
/// instead of the normal equations, so that clusters do not square the condition number. Major
/// steps are limited, as rounding may make a finite method cycle; the iterate with the least
/// possible improvement is returned, and each iterate is a point of the hull. A step is O(n).
/// Requires `points` not to be empty, and each point to have about unit length.
Vec4 min_norm_point(std::span<const Vec4> points);

/// Sixteen units of rounding of a squared unit length.
inline constexpr double kMinNormGap = 8.0 * 2.220446049250313e-16;

}  // namespace camway::geometry
