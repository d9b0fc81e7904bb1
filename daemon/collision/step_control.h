// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/collision/probe.h"

namespace camway::collision {

/// How far the next look along a path should reach: the next stretch if the one seen is free, else
/// another one from the same beginning. As far as what was met leaves room, as the body moves now.
/// Only the number of looks depends on it, nothing that is proved. [Units: metres]
double next_reach_m(const Look& seen);

}  // namespace camway::collision
