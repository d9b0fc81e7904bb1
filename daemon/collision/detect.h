// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/interval.h"
#include "daemon/collision/query.h"
#include "daemon/motion/path/path.h"

namespace camway::collision {

/// Returns all maximal time ranges of [t_begin_s, t_end_s] in which the body collides, in order,
/// each with a witness. All time outside of them is *proved* free, between samples too (`probe.h`).
/// Time inside was seen or proved colliding, could not be decided at the tolerance, or is a free
/// range too short to use (`joining_distance_m`). A body that touches or crosses a surface
/// collides.
///
/// Returns nothing if the deadline struck before the end. Requires segments with increasing times.
std::optional<std::vector<CollisionInterval>> detect_collisions(const Query& query,
                                                                const motion::Path& path,
                                                                double t_begin_s, double t_end_s,
                                                                const base::Deadline& deadline);

/// Result of a search that the deadline may have ended.
struct Search {
  bool complete = false;  ///< false if the deadline struck before the end
  /// Collision intervals that end by `until_s`; defined as for `detect_collisions`.
  std::vector<CollisionInterval> collisions;
  double until_s = 0.0;  ///< end of the time that was searched
};

/// Returns the intervals that `detect_collisions` returns. If the deadline strikes before the end,
/// returns the intervals before `until_s`.
Search search_collisions(const Query& query, const motion::Path& path, double t_begin_s,
                         double t_end_s, const base::Deadline& deadline);

/// Result of `first_collision` and of `any_collision`.
struct FirstCollision {
  bool decided = true;  ///< false if the deadline struck first
  /// Without a witness; nothing if there is no collision.
  std::optional<CollisionInterval> interval;
};
/// Finds the first collision interval in [t_begin_s, t_end_s]: its begin and its end.
FirstCollision first_collision(const Query& query, const motion::Path& path, double t_begin_s,
                               double t_end_s, const base::Deadline& deadline);

/// Decides whether [t_begin_s, t_end_s] is free. If decided, returns no interval exactly if all of
/// it is proved free; then `first_collision` returns none, too. Otherwise returns a short time
/// range at whose middle the body collides, or one that could not be decided at the tolerance.
/// Cheaper than `first_collision` where there is a collision.
FirstCollision any_collision(const Query& query, const motion::Path& path, double t_begin_s,
                             double t_end_s, const base::Deadline& deadline);

}  // namespace camway::collision
