// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::correction {

/// The region about one end of a way out of which a search found no way.
struct Pocket {
  bool is_at_end = false;  ///< true for the end of the way, false for its beginning
  geometry::Box
      reached_W;          ///< a box about the points that the ball's centre can reach from the end
  double unsure_m = 0.0;  ///< by how much the box may be too small: half a cell at its walls
  /// Whether all points that the ball's centre can reach from the end were searched. Otherwise the
  /// search ended at its limit, and the box holds the points reached until then.
  bool is_complete = true;
  /// Whether the search found no point in the pocket that is far from the scene
  /// (`CellOptions::narrow_m`).
  bool is_narrow = false;
};

}  // namespace camway::correction
