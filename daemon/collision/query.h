// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/collision/obstacles.h"
#include "daemon/motion/body/body.h"

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
  /// the time between them is less than joining_distance_m / v. There v is an upper bound of the
  /// body's travel over the whole path, divided by the duration of the path. [Limit: tolerance_m <=
  /// value] [Units: metres]
  double joining_distance_m = 5e-3;
  /// Required clearance: a smaller distance to the scene is a collision. [Limit: 0 <= value]
  /// [Units: metres]
  double clearance_m = 0.0;
};

/// A collision query, which is made of one path after the other: a body, its obstacles, and the
/// definition of a collision of the two. Refers to the body and to the sources of the obstacles,
/// which must outlive it. A value type.
struct Query {
  Obstacles obstacles;
  const motion::Body& body;
  DetectOptions options = {};

  /// Required clearance plus the error of smooth surfaces, without the ball.
  [[nodiscard]] double required_clearance_m() const {
    return options.clearance_m + obstacles.surface_error_m;
  }
};

}  // namespace camway::collision
