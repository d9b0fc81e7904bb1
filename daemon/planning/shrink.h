// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "daemon/base/deadline.h"
#include "daemon/planning/request.h"
#include "daemon/planning/result.h"

namespace camway::planning {

/// Plans for the camera as it is in the request.
using PlanAtSize = std::function<PlanResult(const PlanRequest&, const collision::Deadline&)>;

/// Plans; where that leaves collisions, again with smaller and smaller near distances, down to what
/// `max_shrink` allows, and answers with the largest for which all is free. Which that is, is
/// found by halving the range below which one is: where a camera fits, a smaller one mostly does.
/// If even the smallest does not, the others are tried all the same, since the near quadrilateral
/// of a smaller camera is elsewhere; unless it found a keyframe shut in, for a ball that is smaller
/// than theirs.
///
/// The first plan has half of the deadline, so that the others get their share; each of them has
/// its part of what is left. Where none is free the answer is the first one, its message says what
/// was tried, and its status `timeout` if one of them was cut off. Precondition: 0 < max_shrink,
/// and the camera is what moves.
PlanResult plan_with_shrinking(const PlanRequest& request, const collision::Deadline& deadline,
                               const PlanAtSize& plan_at_size);

}  // namespace camway::planning
