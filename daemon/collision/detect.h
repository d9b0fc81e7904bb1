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

/// Defines what counts as a collision, and how exactly the ends of its interval are known. That
/// resolution is a distance: the motion of the body (`ProbeResult::motion_m`) within a stretch.
struct DetectOptions {
  /// Resolution of the ends of intervals. A stretch that cannot be proved free is divided. It
  /// counts as colliding once its motion is at most this value, if the body collides at its middle,
  /// or at most a tenth of it, if not. [Limit: 0 < value] [Units: metres]
  double tolerance_m = 1e-3;
  /// Joining distance. Within a collision, a stretch whose motion is at most this value counts as
  /// colliding if the body collides at its middle, although parts of it may be free: otherwise a
  /// long collision would be divided down to `tolerance_m` everywhere. Two intervals are joined if
  /// the time between them is less than gap_m / v. There v is an upper bound of the body's travel
  /// over the whole path, divided by the duration of the path. [Limit: tolerance_m <= value]
  /// [Units: metres]
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
    double t_begin_s, double t_end_s, const DetectOptions& options, const base::Deadline& deadline);

/// Result of a search that the deadline may have ended.
struct Search {
  bool complete = false;  ///< false if the deadline struck before the end
  /// Collision intervals that end by `until_s`; defined as for `detect_collisions`.
  std::vector<CollisionInterval> collisions;
  double until_s = 0.0;  ///< end of the time that was searched
};

/// Returns the intervals that `detect_collisions` returns. If the deadline strikes before the end,
/// returns the intervals before `until_s`.
Search search_collisions(const Obstacles& obstacles, const motion::Path& path,
                         const motion::Body& body, double t_begin_s, double t_end_s,
                         const DetectOptions& options, const base::Deadline& deadline);

/// Result of `first_collision`.
struct FirstCollision {
  bool decided = true;  ///< false if the deadline struck first
  /// Begin and end of the interval, without a witness; nothing if there is no collision.
  std::optional<CollisionInterval> interval;
};
/// Finds the first collision interval in [t_begin_s, t_end_s]: its begin and its end.
FirstCollision first_collision(const Obstacles& obstacles, const motion::Path& path,
                               const motion::Body& body, double t_begin_s, double t_end_s,
                               const DetectOptions& options, const base::Deadline& deadline);

}  // namespace camway::collision
