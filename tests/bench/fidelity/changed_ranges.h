// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/motion/spline/cubic_path.h"

namespace camway::bench {

/// A range of time. [Limit: begin_s < end_s]
struct TimeRange {
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// Control points that differ by no more are the same: an answer's keyframes give its path again to
/// `planning::kMostReplanned_m`.
inline constexpr double kSame = 1e-8;

/// Returns the ranges in which `path` differs from `original`, in order of time and apart from one
/// another. Requires the same reference and the same times of begin and end.
std::vector<TimeRange> changed_ranges(const motion::CubicPath& path,
                                      const motion::CubicPath& original);

/// Returns the unions of ranges that overlap or touch, in order of time.
std::vector<TimeRange> joined(std::vector<TimeRange> ranges);

}  // namespace camway::bench
