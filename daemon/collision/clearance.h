// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/collision/deadline.h"
#include "daemon/motion/camera.h"
#include "daemon/motion/path.h"
#include "daemon/scene/scene_index.h"

namespace camway::collision {

/// Least distance between the filled near quadrilateral and the scene over a whole path.
struct PathClearance {
  /// Never above the true least distance; 0 if no distance above 0 could be proved.
  double lower_bound_m = 0.0;
  /// Where it was found to be this or less.
  double upper_bound_m = 0.0;
};

/// How far the lower bound may stay below the upper one, as a share of it, rounding apart.
inline constexpr double kClearanceGap = 0.1;

/// A clearance of more than this is reported as this. Who keeps a hundred metres away from
/// everything does not ask how far exactly, and a scene may be empty. [Units: metres]
inline constexpr double kLargestClearance_m = 100.0;

/// Branch and bound over the path with the bound of `look_at`: a piece is final when its distance
/// is proved to stay within `kClearanceGap` of the least found so far, or above. Covers every
/// instant, rounding included. Nothing if the deadline struck first.
std::optional<PathClearance> path_clearance(const scene::SceneIndex& index,
                                            const motion::Path& path,
                                            const motion::Corners& corners_C,
                                            const Deadline& deadline);

}  // namespace camway::collision
