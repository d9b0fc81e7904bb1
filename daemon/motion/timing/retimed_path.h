// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/spline/cubic_path.h"
#include "daemon/motion/timing/time_law.h"

namespace camway::motion {

/// `path` as a motion of the new times. A time law that is not linear between joints makes other
/// curves of its cubics, so this is the C² cubic spline through its points at the law's knots, with
/// its own velocities at the two ends. It meets the path at the knots, positions bit for bit where
/// they are joints of it; between them it strays by a little, by less the closer the knots, so
/// what was proved of the path has to be proved anew.
/// Precondition: the law is for the time span of the path.
CubicPath retimed(const CubicPath& path, const TimeLaw& law);

/// `path` at the times of a law that stretches all alike: the same control points, bit for bit.
/// Smooth as far as the law stretches all pieces alike: see `stretches_alike`.
CubicPath stretched(const CubicPath& path, const TimeLaw& law);

/// Whether the law stretches each piece of `path` by the same factor but for `kSameRate`.
bool stretches_alike(const CubicPath& path, const TimeLaw& law);

/// Rates of neighbours that differ by a smaller share leave a path smooth: velocities at a join
/// then differ by that share, accelerations by twice that. A thousandth of a millionth: far below
/// what any camera can follow, and above what rounding does to times near 0.
inline constexpr double kSameRate = 1e-9;

}  // namespace camway::motion
