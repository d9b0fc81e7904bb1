// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/collision/obstacles.h"
#include "daemon/motion/body/body.h"

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

/// A body, its obstacles, and what counts as a collision of the two: the question that is asked of
/// one path after the other. Refers to the body and to the sources of the obstacles, which must
/// outlive it. A value type.
struct Query {
  Obstacles obstacles;
  const motion::Body& body;
  DetectOptions options = {};
};

}  // namespace camway::collision
