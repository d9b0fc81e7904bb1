// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/request.h"
#include "daemon/planning/result.h"

namespace camway::planning {

/// Of the deadline, what a plan within bounds may take, so that a way beyond them can be looked
/// for.
inline constexpr double kShareWithinBounds = 0.85;

/// Whether it is worth asking for a way beyond the bounds that `result` had to keep to: the ladder
/// found none within them, and no proof is why.
bool may_have_way_beyond(const PlanRequest& request, const PlanResult& result);

/// Says in the message of `result` that there is a way only beyond its bounds, and how far beyond,
/// if `unbounded` proves one. `unbounded`: of the same request without any bounds. Adds the time
/// that it took.
void add_way_beyond(const PlanResult& unbounded, const PlanRequest& request, PlanResult& result);

}  // namespace camway::planning
