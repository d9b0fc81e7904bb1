// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/collision/query.h"
#include "daemon/motion/timing/time_law.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/planning/stages/correct.h"
#include "daemon/planning/stages/prepare.h"
#include "daemon/planning/stages/slowing.h"

namespace camway::planning {

/// How a path was made to meet motion limits.
struct SlowedPlan {
  std::optional<motion::TimeLaw> law;  ///< law that slowed the path, if any
  bool is_everywhere = false;          ///< no part keeps its time; means nothing without `law`
  bool is_too_fast = false;            ///< whether the deadline came before the path was slowed
  std::optional<LimitBreach> breach;   ///< limits that are not met, where the path is not slowed
};

/// Slows the path of `result` where it exceeds the request's motion limits. If the path may not be
/// slowed, finds where it exceeds them. A path that collides is slowed uniformly, because a new
/// curve would move its collisions. Requires the measures of the path in `result`; without them,
/// which means that the deadline has come, the path is not slowed.
SlowedPlan meet_limits(const collision::Query& query, const PlanRequest& request,
                       const PreparedPlan& prepared, const CorrectedPlan& corrected,
                       const base::Deadline& deadline, PlanResult& result);

}  // namespace camway::planning
