// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/collision/obstacles.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/path.h"

namespace camway::collision {

/// Bounds of the least distance between the body and the scene over a whole path.
struct PathClearance {
  /// A lower bound, rounding included; 0 if no positive distance could be proved.
  double lower_bound_m = 0.0;
  /// An upper bound: a distance that the body has at an instant of the path. `kLargestClearance_m`
  /// if no smaller distance was found.
  double upper_bound_m = 0.0;
  double closest_s = 0.0;  ///< that instant; any if no distance was found
};

/// Largest value of (upper_bound_m - lower_bound_m) / upper_bound_m if `lower_bound_m` > 0, up to
/// rounding.
inline constexpr double kClearanceTolerance = 0.1;

/// Largest clearance that is reported, also for an empty scene. [Units: metres]
inline constexpr double kLargestClearance_m = 100.0;

/// Computes the clearance by branch and bound over the path. A stretch is final once
/// `Probe::check` proves that its distance is at least (1 - `kClearanceTolerance`) times
/// the least distance found so far. The result holds at every instant, rounding included. The
/// bounds of the scene (`Obstacles::bounds`) are not considered. Returns nothing if the deadline
/// strikes first.
std::optional<PathClearance> path_clearance(const Obstacles& obstacles, const motion::Path& path,
                                            const motion::Body& body,
                                            const base::Deadline& deadline);

}  // namespace camway::collision
