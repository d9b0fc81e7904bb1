// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/path/path.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::motion {

/// The C² path through `keyframes`: a cubic interpolating spline with natural ends for the position
/// (two keyframes give a straight line) and a rational interpolating quaternion spline for the
/// orientation (quaternion_spline.h has the method, its source and our deviations). One segment per
/// pair of neighbours, 2 to 64 where neighbours are so far apart on S³ that knots are needed
/// between them. Consecutive segments share their control point at the join bit for bit; its
/// position is that of the keyframe bit for bit, its orientation to rounding.
///
/// The same motion results from every world frame, for q and -q, and (mirrored in time) for the
/// reversed keyframes, up to rounding; half turns between neighbours have a sense of their own
/// (quaternion_spline.h). O(n), deterministic.
/// Requires at least two keyframes, finite numbers, quaternions of unit length to 1e-3 or so (they
/// are normalised) and times strictly increasing, counted from `origin`.
Path interpolate(std::span<const Keyframe> keyframes, const TimeOrigin& origin = {});

/// The same path as the cubic spline that corrections work on.
CubicPath interpolate_cubic(std::span<const Keyframe> keyframes, const TimeOrigin& origin = {});

}  // namespace camway::motion
