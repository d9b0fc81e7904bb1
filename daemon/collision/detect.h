// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/interval.h"
#include "daemon/collision/obstacles.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/path.h"

namespace camway::collision {

/// Defines collisions, and the resolution of their intervals in terms of the motion of the body.
struct DetectOptions {
  /// Resolution of the ends of intervals. A stretch that is not seen colliding but cannot be proved
  /// free at a tenth of this either counts as colliding. [Limit: 0 < value] [Units: metres]
  double tolerance_m = 1e-3;
  /// Joining distance. A free range within a collision that is shorter than this may count as
  /// colliding, so that a long collision is not resolved at `tolerance_m` throughout. Intervals are
  /// joined if they are closer in time than the body takes for this distance on average over the
  /// path. [Limit: tolerance_m <= value] [Units: metres]
  double gap_m = 5e-3;
  /// Required clearance: a smaller distance to the scene is a collision. [Limit: 0 <= value]
  /// [Units: metres]
  double clearance_m = 0.0;
};

/// Returns all maximal time ranges of [t_begin_s, t_end_s] in which the body collides, in order,
/// each with a witness. All time outside of them is *proved* free, between samples too (`probe.h`).
/// Time inside was seen or proved colliding, could not be decided at the tolerance, or is a free
/// range too short to use (`gap_m`). A body that touches or crosses a surface collides.
///
/// Returns nothing if the deadline struck before the end. Requires segments with increasing times.
std::optional<std::vector<CollisionInterval>> detect_collisions(
    const Obstacles& obstacles, const motion::Path& path, const motion::Body& body,
    double t_begin_s, double t_end_s, const DetectOptions& options, const Deadline& deadline);

/// Result of a search that the deadline may have ended.
struct Search {
  bool complete = false;                      ///< false if the deadline struck before the end
  std::vector<CollisionInterval> collisions;  ///< all up to `until_s`, as `detect_collisions`
  double until_s = 0.0;                       ///< end of the time that was searched
};

/// As `detect_collisions`, but returns the collisions up to `until_s` if the deadline struck before
/// the end.
Search search_collisions(const Obstacles& obstacles, const motion::Path& path,
                         const motion::Body& body, double t_begin_s, double t_end_s,
                         const DetectOptions& options, const Deadline& deadline);

/// The first collision interval, with its end but without a witness.
struct FirstCollision {
  bool decided = true;  ///< false if the deadline struck first
  std::optional<CollisionInterval> interval;
};
FirstCollision first_collision(const Obstacles& obstacles, const motion::Path& path,
                               const motion::Body& body, double t_begin_s, double t_end_s,
                               const DetectOptions& options, const Deadline& deadline);

}  // namespace camway::collision
