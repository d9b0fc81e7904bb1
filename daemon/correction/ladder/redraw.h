// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/path/time_origin.h"

namespace camway::correction {

/// Draws changed parts of a path again: relaxes all corrections of a part together, then chooses
/// the fewest knots (`knot_choice.h`) on which the cost grows little (`closeness.h`). Each result
/// is proved free before it replaces the part. `parts`: of `corrected.changed_parts()`.
///
/// The number of steps is limited; they also end at `corrected.deadline()`. Sets the ranges of
/// corrections in `collisions` to the parts that differ from the interpolated path afterwards.
/// `origin`: origin of all times.
void redraw(const std::vector<ChangedPart>& parts, const motion::TimeOrigin& origin,
            FreeSpace& space, CorrectedPath& corrected, CollisionList& collisions);

}  // namespace camway::correction
