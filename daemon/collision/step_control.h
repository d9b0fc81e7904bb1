// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/collision/probe.h"

namespace camway::collision {

/// Returns the reach to aim at for the next stretch. If `seen` is free, the next stretch begins
/// where `seen` ends; otherwise it begins where `seen` begins. The reach is the largest one that
/// the obstacles near `seen` are estimated to allow if the body keeps its motion. The result
/// affects the number of checks, not what is proved. [Units: metres]
double next_reach_m(const ProbeResult& seen);

}  // namespace camway::collision
