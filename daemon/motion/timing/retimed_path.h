// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/spline/cubic_path.h"
#include "daemon/motion/timing/time_law.h"

namespace camway::motion {

/// Returns the path in the new times of `law`: the C² cubic spline through the points of `path` at
/// the law's knots. Its end derivatives are those of `path`, multiplied by the law's rate there.
///
/// The result is another curve, because a time law that is not linear between knots of the path
/// turns cubics into other functions. It meets `path` at the law's knots, and has equal positions,
/// bit for bit, where these are knots of the path. Between the law's knots it deviates, less with
/// closer knots, so it must be proved free anew. Requires the law to cover the time span of `path`.
CubicPath retimed(const CubicPath& path, const TimeLaw& law);

/// Returns `path` with the ends of each piece moved to their times under `law`. The control points
/// stay the same, bit for bit. The result is C² only if `slows_uniformly(path, law)`, up to
/// `kSameRate`.
CubicPath with_new_times(const CubicPath& path, const TimeLaw& law);

/// Returns whether the law multiplies the duration of each piece of `path` by the same factor, up
/// to `kSameRate`.
bool slows_uniformly(const CubicPath& path, const TimeLaw& law);

/// Largest relative difference, which counts as none, between the slow-down of a piece and that of
/// the whole law. Where two pieces join, velocities then differ by at most twice that share, and
/// accelerations by four times it, to first order. That is far below anything that a camera can
/// follow, and above the rounding of times near 0.
inline constexpr double kSameRate = 1e-9;

}  // namespace camway::motion
