// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/motion/timing/time_law.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"

namespace camway::planning {

/// A result whose times are not yet converted to those of the sender. `collisions` and
/// `corrections` have the times of the path before it was slowed, so that the findings for one
/// camera can be reported together with the path of another camera. Everything else has the times
/// of the path in the answer.
struct UnsentResult {
  PlanResult result;
  motion::TimeOrigin origin = {};           ///< origin of its times
  std::optional<motion::TimeLaw> law = {};  ///< set where the path was slowed
};

/// The result with the sender's times.
PlanResult with_sent_times(UnsentResult unsent);

/// Plans for the camera as it is in the request.
using PlanAtSize = std::function<UnsentResult(const PlanRequest&, const base::Deadline&)>;

/// Plans for the camera of the request. If that leaves collisions, plans again with smaller near
/// distances, down to the least that `max_shrink` allows, and answers with the largest one for
/// which the whole path is free. It is found by bisection: if a camera fits, a smaller one usually
/// fits, too. If even the smallest camera does not fit, the others are tried all the same, since
/// their near quadrilaterals are at other places. They are not tried if the smallest camera found a
/// keyframe shut in: that holds for a ball that is smaller than theirs.
///
/// The first plan has half of the deadline, and each other plan its part of the time that is left.
/// If no path is free, the answer is the first one: its message says which near distances were
/// tried, and its status is `timeout` if a plan was cut off. `collisions` and `corrections` are
/// about the camera of the request. Requires 0 < max_shrink, and that the body is a camera.
UnsentResult plan_with_shrinking(const PlanRequest& request, const base::Deadline& deadline,
                                 const PlanAtSize& plan_at_size);

}  // namespace camway::planning
