// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <span>

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Returns the point of the convex hull of `points` that is closest to the origin (Wolfe, "Finding
/// the nearest point in a polytope", Mathematical Programming 11, 1976). It is unique, so up to
/// rounding it does not depend on the frame or on the order of the points. The iteration ends when
/// no point could lower the squared length by more than `kMinNormGap`; the result is then within
/// the square root of `kMinNormGap` of the true point.
///
/// Deviations: the affine sub-problem is solved by a pivoted QR decomposition of the differences
/// instead of the normal equations, so that clusters do not square the condition number. The
/// number of major steps is limited, because rounding may make a finite method cycle. Then the
/// iterate that the remaining steps could improve least is returned; each iterate is a point of the
/// hull. A step is O(n).
///
/// Requires that `points` is not empty and that each point has about unit length. Thread-safe.
Vec4 min_norm_point(std::span<const Vec4> points);

/// The gap of the squared length at which the iteration ends: sixteen units of rounding of 1.
inline constexpr double kMinNormGap = 8.0 * std::numeric_limits<double>::epsilon();

}  // namespace camway::geometry
