// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"

namespace camway::planning {

/// Share of the deadline for a plan within bounds. The rest is for the search of a way beyond them.
inline constexpr double kShareWithinBounds = 0.85;

/// Returns whether a search beyond the bounds of `result` is worthwhile: the ladder found no way
/// within the bounds, and it is not proved that there is none.
bool may_have_way_beyond(const PlanRequest& request, const PlanResult& result);

/// Adds to the message of `result` that there is a way only beyond its bounds, and how far beyond,
/// if `unbounded` proves one. `unbounded` is the result for the same request without any bounds.
/// Adds the time that it took.
void add_way_beyond(const PlanResult& unbounded, const PlanRequest& request, PlanResult& result);

}  // namespace camway::planning
