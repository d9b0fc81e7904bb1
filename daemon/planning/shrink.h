// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/motion/timing/time_law.h"
#include "daemon/planning/request.h"
#include "daemon/planning/result.h"

namespace camway::planning {

/// A result whose times are not the sender's yet. `collisions` and `corrections` have the times of
/// the path before it was slowed, so that what was found for one camera can be told together with
/// the path of another; everything else has those of the path that is answered.
struct UnsentResult {
  PlanResult result;
  motion::TimeOrigin origin = {};           ///< that its times count from
  std::optional<motion::TimeLaw> law = {};  ///< set where the path was slowed
};

/// The result with the sender's times.
PlanResult with_sent_times(UnsentResult unsent);

/// Plans for the camera as it is in the request.
using PlanAtSize = std::function<UnsentResult(const PlanRequest&, const collision::Deadline&)>;

/// Plans; where that leaves collisions, again with smaller and smaller near distances, down to what
/// `max_shrink` allows, and answers with the largest for which all is free. Which that is, is
/// found by halving the range below which one is: where a camera fits, a smaller one mostly does.
/// If even the smallest does not, the others are tried all the same, since the near quadrilateral
/// of a smaller camera is elsewhere; unless it found a keyframe shut in, for a ball that is smaller
/// than theirs.
///
/// The first plan has half of the deadline, so that the others get their share; each of them has
/// its part of what is left. Where none is free the answer is the first one, its message says what
/// was tried, and its status `timeout` if one of them was cut off. What collided, and what became
/// of it, is told of the camera that was asked for. Precondition: 0 < max_shrink, and the camera is
/// what moves.
UnsentResult plan_with_shrinking(const PlanRequest& request, const collision::Deadline& deadline,
                                 const PlanAtSize& plan_at_size);

}  // namespace camway::planning
