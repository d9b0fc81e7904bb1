// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/path/time_origin.h"

namespace camway::correction {

/// Draws the changed parts of a path that was improved for `objective` on fewer knots, where that
/// makes the objective hardly worse. Each result is proved free before it replaces a part, and
/// proved to keep nearly all of the part's least distance from the scene: under `kShortest` and
/// `kSmoothest` as far as that is below `kTightGap`, under `kSafest` as far as it is below
/// `kComfort`. `redraw` does this for `kClosest`.
///
/// `before`: the path before it was improved; parts that are no better than it stay as they are.
/// The number of steps is limited; they also end at `corrected.deadline()`. Sets the ranges of
/// corrections in `collisions`. `origin`: origin of all times.
void spare_keyframes(Objective objective, const motion::CubicPath& before,
                     const motion::TimeOrigin& origin, FreeSpace& space, CorrectedPath& corrected,
                     CollisionList& collisions);

}  // namespace camway::correction
