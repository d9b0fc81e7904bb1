// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/path/candidate.h"
#include "daemon/motion/spline/knot_row.h"

namespace camway::correction {

/// Returns the knots of a short row of bumps about the time from `begin_s` to `end_s`. Knots are
/// about `spacing_s` apart. At least one is in that time, and two are on either side of it, where
/// the offset fades out; the outermost step is short, so that the row accelerates less and ends
/// sooner. If a keyframe is near, the row either ends at the keyframe, or has a knot there and
/// continues beyond, so that the path may change its slope at the keyframe. Every keyframe within
/// the row is at a knot.
///
/// Requires that the time lies within the interval `problem.leg` between keyframes.
/// [Limit: 0 < spacing_s]
motion::KnotRow window_about(const Problem& problem, double begin_s, double end_s,
                             double spacing_s);

}  // namespace camway::correction
