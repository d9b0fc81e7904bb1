// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/collision/probe.h"

namespace camway::collision {

/// Chooses the reach of the next stretch: the following one if `seen` is free, otherwise another
/// one from the same beginning. As long as the obstacles met allow at the current motion. Only the
/// number of checks depends on it, no proof. [Units: metres]
double next_reach_m(const Look& seen);

}  // namespace camway::collision
