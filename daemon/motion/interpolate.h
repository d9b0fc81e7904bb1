// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "daemon/motion/keyframe.h"
#include "daemon/motion/path.h"

namespace camway::motion {

/// Times for poses that came without: chord length blended with the turning angle, so that turning
/// on the spot takes time and so do repeated poses. Starts at 0, strictly increasing.
/// Precondition: at least two poses.
std::vector<double> derive_times_s(std::span<const Pose> poses);

/// The C² path through `keyframes`: a cubic interpolating spline for the position and a rational
/// interpolating quaternion spline for the orientation. One segment per pair of neighbours, more
/// where neighbours are so far apart on S³ that an extra knot is needed.
/// Preconditions: at least two keyframes, finite, unit quaternions, times strictly increasing.
/// The same motion results from every world frame, for q and -q, and (mirrored in time) for the
/// reversed keyframes.
Path interpolate(std::span<const Keyframe> keyframes);

}  // namespace camway::motion
