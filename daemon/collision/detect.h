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
/// each with a witness. A body that touches or crosses a surface collides.
///
/// All time outside of the ranges is *proved* free, between samples too (`probe.h`). Inside a range
/// the body was found or proved to collide, or it could not be decided at the tolerance whether it
/// collides, or the time between two collisions was too short (`joining_distance_m`).
///
/// Returns nothing if the deadline strikes before the end. Requires segments with increasing times.
/// Thread-safe.
std::optional<std::vector<CollisionInterval>> detect_collisions(const Query& query,
                                                                const motion::Path& path,
                                                                double t_begin_s, double t_end_s,
                                                                const base::Deadline& deadline);

/// Result of `search_collisions`.
struct FoundCollisions {
  bool complete = false;  ///< false if the deadline struck before the end
  /// Collision intervals that end by `until_s`, as `detect_collisions` defines them.
  std::vector<CollisionInterval> collisions;
  double until_s = 0.0;  ///< end of the time that was searched
};

/// Does what `detect_collisions` does, but if the deadline strikes before the end, returns the
/// intervals up to there.
FoundCollisions search_collisions(const Query& query, const motion::Path& path, double t_begin_s,
                                  double t_end_s, const base::Deadline& deadline);

/// Removes from `collisions`, which one of the above found on `path`, those that are proved free if
/// the tolerance is `kFinerTolerance` of that of `query`. It is partly chance which stretches of a
/// path that almost touches the scene can be proved free at a tolerance, so a path that was proved
/// free in parts may seem to collide as a whole. Stops at the deadline.
void remove_undecided(const Query& query, const motion::Path& path, const base::Deadline& deadline,
                      std::vector<CollisionInterval>& collisions);
inline constexpr double kFinerTolerance = 1.0 / 64.0;

/// Result of `first_collision`, `first_contact` and `any_collision`.
struct FirstCollision {
  bool decided = true;  ///< false if the deadline struck first
  /// The collision, without a witness; nothing if there is none. Meaningful if `decided`.
  std::optional<CollisionInterval> interval;
};
/// Returns the first collision interval in [t_begin_s, t_end_s], as `detect_collisions` defines it.
FirstCollision first_collision(const Query& query, const motion::Path& path, double t_begin_s,
                               double t_end_s, const base::Deadline& deadline);

/// Returns the beginning of the first collision interval: `t_begin_s` is that of `first_collision`,
/// and `t_end_s` the end of the first stretch that is not free. Cheaper than `first_collision` if
/// there is a collision.
FirstCollision first_contact(const Query& query, const motion::Path& path, double t_begin_s,
                             double t_end_s, const base::Deadline& deadline);

/// Decides whether [t_begin_s, t_end_s] is free. Returns no interval if all of it is proved free;
/// then `first_collision` returns none either. Otherwise returns a short time range at whose middle
/// the body collides, or for which it could not be decided at the tolerance whether it collides.
/// Cheaper than `first_contact` if there is a collision.
FirstCollision any_collision(const Query& query, const motion::Path& path, double t_begin_s,
                             double t_end_s, const base::Deadline& deadline);

}  // namespace camway::collision
