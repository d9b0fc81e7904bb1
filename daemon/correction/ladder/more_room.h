// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/path/time_origin.h"

namespace camway::correction {

/// Corrects intervals between keyframes with more distance from the scene, for `kSafest`. `polish`
/// alone lessens the danger on the whole, and may leave the narrowest place as it is.
///
/// Each interval with corrections is corrected with a larger clearance: the least that suffices for
/// `kSafest` or that its keyframes have; where that fails, with less, a limited number of times.
/// Collisions with that clearance are corrected by moves on top of the corrected path, or else from
/// the path as interpolated. Intervals that share a changed part are corrected together.
///
/// A result replaces the corrections if its least gap is larger by enough and it does not lead much
/// farther off. It turns the body only where the corrections do that it replaces. Intervals with
/// open collisions stay as they are. Returns whether any correction was replaced.
///
/// Requires `space` to be that of the corrections. Sets the ranges of `collisions`. `origin`:
/// origin of all times. `seed`: random seed of searches for detours. Ends at
/// `corrected.deadline()`.
bool make_more_room(const motion::TimeOrigin& origin, std::uint64_t seed, FreeSpace& space,
                    CorrectedPath& corrected, CollisionList& collisions);

}  // namespace camway::correction
