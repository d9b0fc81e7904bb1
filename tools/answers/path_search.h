// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/detect.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/path.h"
#include "daemon/planning/result/result.h"

namespace camway::tools {

/// The result of the search of a path for collisions.
struct PathSearch {
  /// Whether the search reached the end of the path before the deadline.
  bool complete = false;
  /// End of the time that was searched. Until then, every instant outside of `collisions` is proved
  /// free, joins of segments included. [Units: seconds]
  double searched_until_s = 0.0;
  /// Collision intervals in order, merged where they touch.
  std::vector<collision::CollisionInterval> collisions;
  /// Certified exactly if the search is complete and found no collision.
  planning::Certificate certificate;
};

/// Searches a path for collisions. Also searches the straight motions across joins of segments
/// whose ends differ (`planning::bridges`); a collision of such a motion counts at the instant of
/// the join. If nothing collides, bounds the clearance.
///
/// The path is searched in a hundred parts in order of time, so that the results before the
/// deadline are kept. Two intervals on either side of a border of two parts are joined only if they
/// touch, not over the joining distance (`collision::DetectOptions::joining_distance_m`). Requires
/// a path in which `planning::find_fault` and `find_jump` find nothing.
PathSearch search_path(const collision::Query& query, const motion::Path& path,
                       const base::Deadline& deadline);

}  // namespace camway::tools
