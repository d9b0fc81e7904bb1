// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/spline/cubic_path.h"
#include "tests/bench/fidelity/changed_ranges.h"

namespace camway::bench {

/// A part of a path that differs from the path as interpolated within `range` at most.
struct PathPart {
  TimeRange range;
  const motion::CubicPath* path;  ///< the whole path
};

/// Returns the path that is each part's in its range and `interpolated` elsewhere. It is C², since
/// it is the spline through the joints of them all. Requires ranges in order of time that do not
/// overlap; `given`: the keyframes that all paths meet.
motion::CubicPath assembled(const motion::CubicPath& interpolated,
                            std::span<const motion::Keyframe> given,
                            std::span<const PathPart> parts);

}  // namespace camway::bench
