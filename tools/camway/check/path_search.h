// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/detect.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/path.h"
#include "daemon/planning/result.h"

namespace camway::tools {

/// What is known of a path that somebody made.
struct PathSearch {
  /// False if the deadline struck before the end.
  bool complete = false;
  /// Up to here all is known: what `collisions` does not list is proved free, joins included.
  double searched_until_s = 0.0;
  /// In order, maximal as far as the search came; none overlaps or touches the next.
  std::vector<collision::CollisionInterval> collisions;
  /// Certified exactly if complete and without collisions.
  planning::Certificate certificate;
};

/// Searches a path and the straight motions that close its gaps (`planning::bridges`) for
/// collisions, from the beginning to the end, so that a deadline does not take what was found
/// before it; where nothing collides, bounds the clearance. A scene that stands in a gap is a
/// collision at that instant. Two intervals on both sides of a multiple of a hundredth of the path
/// are not joined over a gap that nobody could use (`collision::DetectOptions::gap_m`).
/// Precondition: `planning::find_fault` and `find_jump` find nothing.
PathSearch search_path(const collision::Obstacles& obstacles, const motion::Path& path,
                       const motion::Body& body, const collision::DetectOptions& options,
                       const base::Deadline& deadline);

}  // namespace camway::tools
