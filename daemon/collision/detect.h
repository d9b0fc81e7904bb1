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
/// range too short to use (`gap_m`). A body that touches or crosses a surface collides.
///
/// Returns nothing if the deadline struck before the end. Requires segments with increasing times.
std::optional<std::vector<CollisionInterval>> detect_collisions(const Query& query,
                                                                const motion::Path& path,
                                                                double t_begin_s, double t_end_s,
                                                                const base::Deadline& deadline);

/// Result of a search that the deadline may have ended.
struct Search {
  bool complete = false;                      ///< false if the deadline struck before the end
  std::vector<CollisionInterval> collisions;  ///< all up to `until_s`, as `detect_collisions`
  double until_s = 0.0;                       ///< end of the time that was searched
};

/// As `detect_collisions`, but returns the collisions up to `until_s` if the deadline struck before
/// the end.
Search search_collisions(const Query& query, const motion::Path& path, double t_begin_s,
                         double t_end_s, const base::Deadline& deadline);

/// The first collision interval, with its end but without a witness.
struct FirstCollision {
  bool decided = true;  ///< false if the deadline struck first
  std::optional<CollisionInterval> interval;
};
FirstCollision first_collision(const Query& query, const motion::Path& path, double t_begin_s,
                               double t_end_s, const base::Deadline& deadline);

}  // namespace camway::collision
