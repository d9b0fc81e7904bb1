// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/base/budget.h"
#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/path/time_origin.h"

namespace camway::correction {

/// Improves the corrected intervals of a path, each step proved free:
/// 1. It relaxes each interval again, now that its neighbours are final, and once more where a
///    neighbour changed. This spends steps of `budget`.
/// 2. It pulls intervals that ended far from the interpolated path closer, the farthest first,
///    unless the path then bends much more. Most paths have none.
/// 3. It pursues `objective`, if that is another than the closest path. Every objective starts from
///    the closest path and accepts only what is better by its own measure, so no objective ends
///    with less of it than another.
///
/// Steps are counted, and end with `corrected.deadline()`. Extends the ranges of corrections in
/// `collisions` by what it changes. `origin`: origin of all times.
void polish(Objective objective, const motion::TimeOrigin& origin, base::Budget& budget,
            FreeSpace& space, CorrectedPath& corrected, CollisionList& collisions);

}  // namespace camway::correction
