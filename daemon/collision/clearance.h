// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/collision/obstacles.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/path.h"

namespace camway::collision {

/// Least distance between the body and the scene over a whole path.
struct PathClearance {
  /// Never above the true least distance; 0 if no distance above 0 could be proved.
  double lower_bound_m = 0.0;
  /// Where it was found to be this or less.
  double upper_bound_m = 0.0;
};

/// How far the lower bound may stay below the upper one, as a share of it, rounding apart.
inline constexpr double kClearanceGap = 0.18;

/// A clearance of more than this is reported as this. Who keeps a hundred metres away from
/// everything does not ask how far exactly, and a scene may be empty. [Units: metres]
inline constexpr double kLargestClearance_m = 100.0;

/// Branch and bound over the path with the bound of `Probe::look`: a stretch is final when its
/// distance is proved to stay within `kClearanceGap` of the least found so far, or above. Covers
/// every instant, rounding included. Bounds do not count. Nothing if the deadline struck first.
std::optional<PathClearance> path_clearance(const Obstacles& obstacles, const motion::Path& path,
                                            const motion::Body& body, const Deadline& deadline);

}  // namespace camway::collision
