// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/spline/cubic_path.h"
#include "daemon/motion/timing/time_law.h"

namespace camway::motion {

/// Returns `path` with the new times of `law`. A time law that is not linear between joints turns
/// the cubics of the path into other curves. So the result is the C² cubic spline through the
/// points of the path at the law's knots, with the path's velocities at its two ends. The result
/// meets the path at the knots, with positions equal bit for bit at joints of the path. Between the
/// knots it deviates, less with closer knots, so the path must be proved free anew. Requires the
/// law to cover the time span of the path.
CubicPath retimed(const CubicPath& path, const TimeLaw& law);

/// Returns `path` at the times of a law that stretches all times alike. The control points are the
/// same, bit for bit. The result is smooth if `stretches_alike` is true.
CubicPath stretched(const CubicPath& path, const TimeLaw& law);

/// Whether the law stretches each piece of `path` by the same factor, up to `kSameRate`.
bool stretches_alike(const CubicPath& path, const TimeLaw& law);

/// Largest relative difference of the rates of neighbouring pieces that keeps a path smooth:
/// velocities at a join then differ by that share, accelerations by twice that. A thousandth of a
/// millionth is far below what any camera can follow, and above the rounding of times near 0.
inline constexpr double kSameRate = 1e-9;

}  // namespace camway::motion
