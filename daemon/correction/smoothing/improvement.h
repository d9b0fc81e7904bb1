// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/path/constraints.h"

namespace camway::correction {

/// Steps that suffice to compare corrections. The one that is taken is relaxed further when it is
/// drawn again (`redraw`).
inline constexpr int kStepsOfChoice = 4;

/// Goal of a relaxation.
struct Improvement {
  Objective objective = Objective::kClosest;
  bool may_turn = true;  ///< false keeps orientations, even if the orientation policy allows a turn
  /// Whether missing gaps have a price (`ContactBounds`), so that the path moves away from what it
  /// passes where this costs little. No effect for `kSafest`, which always makes room.
  bool makes_room = false;
  int most_steps = 12;  ///< of one relaxation [Limit: 0 <= value]
  double worth = 0.1;   ///< least relative gain of the objective for which `polished` takes steps
};

}  // namespace camway::correction
