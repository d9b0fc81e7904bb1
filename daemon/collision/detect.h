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

/// What counts as a collision, and how finely collisions are resolved, as motion of the body.
struct DetectOptions {
  /// Ends of intervals are bracketed to this. A stretch that is not seen colliding, but cannot be
  /// shown free at a tenth of this either, counts as colliding. [Limit: 0 < value] [Units: metres]
  double tolerance_m = 1e-3;
  /// Inside a colliding stretch, a free gap shorter than this may be counted as colliding, so that
  /// a long collision does not cost the finest resolution everywhere; and intervals closer in time
  /// than the body takes for this on average over the path are joined, as nobody could use the gap.
  /// [Limit: tolerance_m <= value] [Units: metres]
  double gap_m = 5e-3;
  /// Being nearer to the scene than this is a collision. [Limit: 0 <= value] [Units: metres]
  double clearance_m = 0.0;
};

/// All maximal stretches of [t_begin_s, t_end_s] in which the body collides, in order, each with a
/// witness. Everything outside them is *proved* free, between samples too (`probe.h`); what is
/// inside was seen colliding, or was proved to, or could not be told at the tolerance, or is a gap
/// that nobody could use. The body collides with a surface that it crosses or touches.
///
/// Nothing if the deadline struck before the end. Precondition: segments with increasing times.
std::optional<std::vector<CollisionInterval>> detect_collisions(
    const Obstacles& obstacles, const motion::Path& path, const motion::Body& body,
    double t_begin_s, double t_end_s, const DetectOptions& options, const Deadline& deadline);

/// What a search found, which the deadline may have ended.
struct Search {
  bool complete = false;
  std::vector<CollisionInterval> collisions;  ///< all up to `until_s`, as `detect_collisions` says
  double until_s = 0.0;                       ///< beyond, nothing is known
};

/// As `detect_collisions`, with what is known where the deadline struck before the end.
Search search_collisions(const Obstacles& obstacles, const motion::Path& path,
                         const motion::Body& body, double t_begin_s, double t_end_s,
                         const DetectOptions& options, const Deadline& deadline);

/// Only the first of them, with its end, and without a witness: who looks for a path has no use for
/// one.
struct FirstCollision {
  bool decided = true;  ///< false if the deadline struck first
  std::optional<CollisionInterval> interval;
};
FirstCollision first_collision(const Obstacles& obstacles, const motion::Path& path,
                               const motion::Body& body, double t_begin_s, double t_end_s,
                               const DetectOptions& options, const Deadline& deadline);

}  // namespace camway::collision
