// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/collision/interval.h"
#include "daemon/collision/probe.h"

namespace camway::collision {

/// Returns the deepest contact of the body, at the middle of `stretch`, with a triangle of the
/// scene or a side of the bounds; nothing if there is none. An obstacle also counts, with depth 0,
/// if its distance exceeds the required clearance by at most `beyond_m`. Among triangles that the
/// body touches or is too close to at equal depth, returns the one with the lowest number. Does not
/// set `Witness::time_s`. [Limit: 0 <= beyond_m]
///
/// The depth of two triangles that cross is the least translation along the normal of either that
/// separates them; of two that are merely too close, the missing distance; of a triangle inside a
/// solid of the body, its depth in the solid.
std::optional<Witness> deepest_contact(Probe& probe, const motion::Stretch& stretch,
                                       double beyond_m);

}  // namespace camway::collision
