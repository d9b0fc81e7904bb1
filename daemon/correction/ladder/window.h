// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/path/candidate.h"
#include "daemon/motion/spline/knot_row.h"

namespace camway::correction {

/// Returns the knots of a short row of bumps about the time from `begin_s` to `end_s`, about
/// `spacing_s` apart: one knot or more in that time, and two on either side, so that the offset
/// fades out there. Where a keyframe is near, the row ends at it or has a knot at it, and goes on
/// beyond: the path may then change its slope at the keyframe. Every keyframe within the row is at
/// a knot.
///
/// Requires a time within the interval `problem.leg`. [Limit: 0 < spacing_s]
motion::KnotRow window_about(const Problem& problem, double begin_s, double end_s,
                             double spacing_s);

}  // namespace camway::correction
