// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "daemon/correction/path/constraints.h"
#include "daemon/motion/spline/cubic_path.h"
#include "tests/bench/fidelity/changed_ranges.h"
#include "tests/bench/fidelity/range_search.h"
#include "tests/bench/fidelity/shot.h"

namespace camway::bench {

/// Returns the intervals between keyframes in which some path differs from the path as
/// interpolated, in order of time; those that touch are one range.
std::vector<TimeRange> compared_ranges(const Shot& shot, std::span<const motion::CubicPath> paths);

/// The ranges in which the slow reference of an objective may change the closest path, and those on
/// which it is compared.
struct Extent {
  std::vector<TimeRange> searched;  ///< those in which the closest path or the answer is changed
  /// The same; for `kSafest` those in which the closest path is changed. A correction reaches a
  /// little over a keyframe, and what is beside the path there says nothing about it.
  std::vector<TimeRange> compared;
};
Extent extent_of(correction::Objective objective, const Shot& shot,
                 const motion::CubicPath& closest, const motion::CubicPath& answer);

/// Returns the starts of the slow reference of an objective, `closest` and `answer` first:
/// - answers of the objective with other seeds;
/// - for `kSafest`, answers of the default objective with a required clearance, from most of the
///   gap of the keyframes of a compared range (at most `sufficient_gap_m`) down to a part of it.
///
/// Each start is cut to one of the searched ranges at a time: elsewhere it is `closest`. So a start
/// counts although it fails or changes more in another range. Only starts that are proved free with
/// the request's clearance, that turn no more than `closest` in any interval between keyframes,
/// and, for `kSafest`, that do not lead much farther off, as planning does not either. `closest`
/// and `answer` are exempt.
std::vector<motion::CubicPath> starts_of(correction::Objective objective, const Shot& shot,
                                         const motion::CubicPath& closest,
                                         const motion::CubicPath& answer, const Extent& extent);

/// Returns the clearance that the search for an objective keeps. Planning takes no step that
/// reduces the least gap below that of the closest path, or below `kTightGap` if that is less; so
/// for `kShortest` and `kSmoothest` the search keeps most of that, up to `kSlack_m`, and else the
/// clearance of the request. [Units: metres]
double kept_clearance_m(correction::Objective objective, const Shot& shot,
                        const motion::CubicPath& closest, std::span<const TimeRange> ranges);
inline constexpr double kTightGap = 0.02;  ///< in radii of the ball that holds the body

/// The slow reference of an objective: the best path that is known, by `value_of` in what is
/// compared of each searched range. It searches each range by itself for the goals of the objective
/// (`goals_of`), one after the other. The search keeps `effort.clearance_m`, if that is more than
/// the clearance of the request; starts need not.
///
/// Returns a path that is proved free and is `starts.front()` outside of the searched ranges. It is
/// in none of them worse than a start. Requires starts that are proved free with the clearance of
/// the request and equal outside of the ranges, a compared range in each searched one, and an
/// objective other than `kClosest`.
motion::CubicPath best_by_objective(correction::Objective objective, const Shot& shot,
                                    std::span<const motion::CubicPath> starts, const Extent& extent,
                                    const SearchEffort& effort);

/// Whether a value of an objective is less good than another one by more than a share of it.
bool is_worse(correction::Objective objective, double value, double other, double by_share = 0.0);

}  // namespace camway::bench
