// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::correction {

/// The end of a way from which less can be reached.
struct Pocket {
  bool is_at_end = false;   ///< or at the begin
  geometry::Box reached_W;  ///< about all places of the ball's middle that were reached from there
};

}  // namespace camway::correction
