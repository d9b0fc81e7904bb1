// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/cubic_path.h"
#include "daemon/motion/time_law.h"

namespace camway::motion {

/// `path` as a motion of the new times. A time law that is not linear between joints makes other
/// curves of its cubics, so this is the C² cubic spline through its points at the law's knots, with
/// its own velocities at the two ends. It meets the path at the knots, positions bit for bit where
/// they are joints of it; between them it strays by a little, by less the closer the knots, so
/// what was proved of the path has to be proved anew.
/// Precondition: the law is for the time span of the path.
CubicPath retimed(const CubicPath& path, const TimeLaw& law);

/// `path` at the times of a law that stretches all alike: the same control points, bit for bit.
CubicPath stretched(const CubicPath& path, const TimeLaw& law);

}  // namespace camway::motion
