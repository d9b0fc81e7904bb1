// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/collision/obstacles.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"

namespace camway::planning {

/// Share of the deadline for a plan within bounds. The rest is for the plan without bounds.
inline constexpr double kShareWithinBounds = 0.85;

/// Returns whether a plan without bounds is worthwhile: the ladder found no free path within the
/// bounds of `result`, and it is not proved that there is none.
bool may_have_path_outside_bounds(const PlanRequest& request, const PlanResult& result);

/// Adds the time that `unbounded` took to that of `result`. If `unbounded` has a path that is
/// proved free, also adds to the message of `result` that a free path was found only outside of its
/// bounds, and by how much. `unbounded`: the result for the same request without bounds.
void add_path_outside_bounds(const PlanResult& unbounded, const collision::Obstacles& obstacles,
                             const PlanRequest& request, PlanResult& result);

}  // namespace camway::planning
