// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/path/time_origin.h"

namespace camway::correction {

/// Improves the corrected intervals of a path under an objective other than `kClosest`. Each step
/// is proved free, and only steps are accepted that are better by the objective's own measure. So
/// by that measure the result is never worse than the path was. Returns whether any step was
/// better. Changes nothing for `kClosest`, which every correction optimises itself.
///
/// Under `kShortest` and `kSmoothest` the path may come as near to the scene as `kTightGap`; where
/// it was nearer, it keeps all but a twentieth of its distance.
///
/// The number of steps is limited; they also end at `corrected.deadline()`. Extends the ranges of
/// corrections in `collisions` by the changed parts. `origin`: origin of all times.
bool polish(Objective objective, const motion::TimeOrigin& origin, FreeSpace& space,
            CorrectedPath& corrected, CollisionList& collisions);

}  // namespace camway::correction
