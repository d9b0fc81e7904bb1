// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::correction {

/// The end of a way from which less can be reached.
struct Pocket {
  bool is_at_end = false;   ///< or at the begin
  geometry::Box reached_W;  ///< about what the ball's middle can reach from there
  double unsure_m = 0.0;    ///< by how much that may be too small: half of a cell at its walls
};

}  // namespace camway::correction
