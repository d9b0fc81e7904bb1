// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/collision/interval.h"
#include "daemon/collision/probe.h"

namespace camway::collision {

/// The deepest contact of the body, where the middle of `stretch` has it, with a triangle of the
/// scene or a side of the bounds. What is up to `beyond_m` further away than required counts, with
/// depth 0. Nothing if there is none. The time is left 0.
///
/// The depth of two triangles that cross is the least way along the normal of either that takes
/// them apart; where they are merely too close, what is missing in distance; of what a solid of the
/// body holds without touching it, how deep it is inside.
std::optional<Witness> deepest_contact(Probe& probe, const motion::Stretch& stretch,
                                       double beyond_m);

}  // namespace camway::collision
