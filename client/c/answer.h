// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <camway/plan.h>

namespace camway::c {

/// Returns an interval as one of the C interface; its text belongs to `from`.
camway_collision collision_of(const CollisionInterval& from);

}  // namespace camway::c
