// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "daemon/correction/ladder/collision_list.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/path/time_origin.h"

namespace camway::correction {

/// Corrects intervals between keyframes anew, with more distance from the scene, for `kSafest`.
/// Relaxation alone finds no other way than the one that it starts from.
///
/// Each interval with corrections is corrected with a required clearance that its two keyframes
/// keep, and that suffices for `kSafest`; where that fails, with less, a limited number of times.
/// Intervals that share a changed part are corrected together. A result replaces the corrections
/// if its least gap is larger by enough. It turns the body only where the corrections do that it
/// replaces. Returns whether any was replaced.
///
/// Requires `space` to be that of the corrections. Sets the ranges of `collisions`. `origin`:
/// origin of all times. `seed`: random seed of searches for detours. Ends at
/// `corrected.deadline()`.
bool make_more_room(const motion::TimeOrigin& origin, std::uint64_t seed, FreeSpace& space,
                    CorrectedPath& corrected, CollisionList& collisions);

}  // namespace camway::correction
