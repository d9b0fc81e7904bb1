// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/path/time_origin.h"

namespace camway::correction {

/// Improves the corrected intervals of a path under an objective other than the closest path, each
/// step proved free. Every objective starts from the closest path and accepts only what is better
/// by its own measure, so no objective ends with less of it than another. Changes nothing for
/// `kClosest`, which every correction pursues by itself.
///
/// Steps are counted, and end with `corrected.deadline()`. Extends the ranges of corrections in
/// `collisions` by what it changes. `origin`: origin of all times.
void polish(Objective objective, const motion::TimeOrigin& origin, FreeSpace& space,
            CorrectedPath& corrected, CollisionList& collisions);

}  // namespace camway::correction
