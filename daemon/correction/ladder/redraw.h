// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/path/time_origin.h"

namespace camway::correction {

/// Draws each changed part of a path again: relaxes all its corrections together, then draws them
/// on as few knots (`knot_choice.h`) as cost little more (`closeness.h`). Each result is proved
/// free before it replaces the part.
///
/// Steps are counted, and end with `corrected.deadline()`. Sets the ranges of corrections in
/// `collisions` to what is changed afterwards. `origin`: origin of all times.
void redraw(const motion::TimeOrigin& origin, FreeSpace& space, CorrectedPath& corrected,
            CollisionList& collisions);

}  // namespace camway::correction
