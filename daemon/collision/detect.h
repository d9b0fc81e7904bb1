// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "daemon/collision/deadline.h"
#include "daemon/collision/interval.h"
#include "daemon/motion/camera.h"
#include "daemon/motion/path.h"
#include "daemon/scene/scene_index.h"

namespace camway::collision {

/// How finely collisions are resolved, as motion of a corner.
struct DetectOptions {
  /// Ends of intervals are bracketed to this; a stretch that cannot be shown free at this
  /// resolution counts as colliding. [Limit: 0 < value] [Units: metres]
  double tolerance_m = 1e-4;
  /// Inside a colliding stretch, a free gap shorter than this may be counted as colliding, so that
  /// a long collision does not cost the finest resolution everywhere; and intervals closer in time
  /// than the body takes for this on average over the path are joined, as nobody could use the gap.
  /// [Limit: tolerance_m <= value] [Units: metres]
  double gap_m = 5e-3;
};

/// All maximal stretches of [t_begin_s, t_end_s] in which the filled near quadrilateral collides,
/// in order. Everything outside them was shown free by distance, between samples too: a stretch
/// about a middle pose is free if the scene is further away there than any point of the body moves
/// within the stretch (He & van den Berg 2014, with the motion bound of `motion/motion_bound.h`).
/// Nothing if the deadline struck before the end.
std::optional<std::vector<CollisionInterval>> detect_collisions(
    const scene::SceneIndex& index, const motion::Path& path, const motion::Corners& corners_C,
    double t_begin_s, double t_end_s, const DetectOptions& options, const Deadline& deadline);

/// Only the first of them, with its end.
struct FirstCollision {
  bool decided = true;  ///< false if the deadline struck first
  std::optional<CollisionInterval> interval;
};
FirstCollision first_collision(const scene::SceneIndex& index, const motion::Path& path,
                               const motion::Corners& corners_C, double t_begin_s, double t_end_s,
                               const DetectOptions& options, const Deadline& deadline);

}  // namespace camway::collision
