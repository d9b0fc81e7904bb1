// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daemon/correction/path/free_space.h"
#include "daemon/motion/spline/cubic_path.h"
#include "tests/bench/fidelity/changed_ranges.h"
#include "tests/bench/fidelity/goal.h"
#include "tests/bench/fidelity/shot.h"

namespace camway::bench {

/// Effort of the slow reference.
struct SearchEffort {
  double seconds = 2.0;  ///< processor time of the searches of a shot, without its plans
  std::uint64_t seed = 1;
  /// Clearance that the search keeps, at least the required one. [Units: metres]
  double clearance_m = 0.0;
};

/// The search keeps so much more than the required clearance. Detection counts a stretch as
/// colliding that it cannot prove free while the body moves by a tenth of the interval tolerance;
/// where the gap is larger than that, every division of the path proves it.
inline constexpr double kSlack_m = 1e-4;

/// Searches one range (`LocalSearch`) from those starts that cost least there and differ from one
/// another: each has a trial, and the one that is then cheapest has the rest of the time. Returns
/// the whole path of the best. Requires at least one start; `space`: of the shot, with a clearance
/// that all starts are proved to keep.
motion::CubicPath searched(const Shot& shot, const Goal& goal, const correction::FreeSpace& space,
                           std::span<const motion::CubicPath> starts, const TimeRange& range,
                           const SearchEffort& effort);

/// Returns the paths that are proved to keep this clearance.
std::vector<motion::CubicPath> free_with(const Shot& shot, std::span<const motion::CubicPath> paths,
                                         double clearance_m);

}  // namespace camway::bench
