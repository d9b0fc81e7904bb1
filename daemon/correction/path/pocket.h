// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::correction {

/// The region about one end of a way out of which a search found no way: of the two ends, the one
/// from which less is reachable.
struct Pocket {
  bool is_at_end = false;   ///< true for the end of the way, false for its beginning
  geometry::Box reached_W;  ///< about all points that the ball's centre can reach from there
  double unsure_m = 0.0;    ///< how much too small the box may be: half a cell at its walls
  /// Whether all points that the ball's centre can reach from there were searched. Otherwise the
  /// search ended at its limit: the box has what was reached until then.
  bool is_complete = true;
  /// Whether no point was found there that is far from the scene (`CellOptions::narrow_m`).
  bool is_narrow = false;
};

}  // namespace camway::correction
