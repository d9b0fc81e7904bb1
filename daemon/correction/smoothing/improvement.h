// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/path/constraints.h"

namespace camway::correction {

/// Goal of a relaxation.
struct Improvement {
  Objective objective = Objective::kClosest;
  bool may_turn = true;  ///< false keeps orientations, even if the orientation policy allows a turn
  /// Whether missing gaps have a price (`ContactBounds`), so that the path moves away from what it
  /// passes where this costs little. No effect for `kSafest`, which always makes room.
  bool makes_room = false;
  double worth = 0.1;  ///< least relative gain of the objective for which `polished` takes steps
};

}  // namespace camway::correction
