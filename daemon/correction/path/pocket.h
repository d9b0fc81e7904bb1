// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::correction {

/// The region that shuts in one end of a way: of the two ends, the one from which less is
/// reachable.
struct Pocket {
  bool is_at_end = false;   ///< true for the end of the way, false for its beginning
  geometry::Box reached_W;  ///< about all points that the ball's centre can reach from there
  double unsure_m = 0.0;    ///< how much too small the box may be: half a cell at its walls
};

}  // namespace camway::correction
