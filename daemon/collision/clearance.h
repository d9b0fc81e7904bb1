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
  /// Never above the true least distance; 0 if no positive distance could be proved.
  double lower_bound_m = 0.0;
  /// Somewhere the distance was found to be this or less; at most `kLargestClearance_m`.
  double upper_bound_m = 0.0;
};

/// Largest gap between the two bounds, as a share of the upper one, rounding apart.
inline constexpr double kClearanceGap = 0.18;

/// Largest clearance that is reported; a scene may be empty, and larger values are of no use.
/// [Units: metres]
inline constexpr double kLargestClearance_m = 100.0;

/// Computes the clearance by branch and bound over the path, with the bound of `Probe::look`: a
/// stretch is final when its distance is proved to be nowhere below the least distance found so far
/// by more than `kClearanceGap`. Covers every instant, rounding included. Ignores bounds. Returns
/// nothing if the deadline strikes first.
std::optional<PathClearance> path_clearance(const Obstacles& obstacles, const motion::Path& path,
                                            const motion::Body& body, const Deadline& deadline);

}  // namespace camway::collision
