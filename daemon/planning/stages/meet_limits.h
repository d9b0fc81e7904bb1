// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/collision/query.h"
#include "daemon/motion/timing/time_law.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/planning/stages/correct.h"
#include "daemon/planning/stages/limits.h"
#include "daemon/planning/stages/prepare.h"

namespace camway::planning {

/// How a path was made to meet motion limits.
struct SlowedPlan {
  std::optional<motion::TimeLaw> law;  ///< law that slowed the path, if any
  bool is_everywhere = false;          ///< slowed alike all the way; means nothing without `law`
  bool is_too_fast = false;            ///< the deadline came before the path was slowed
  std::optional<LimitBreach> breach;   ///< limits that are not met, where the path is not slowed
};

/// Slows the path of `result` where it exceeds the request's motion limits, or finds where that is,
/// if the path may not be slowed. A path that collides is not worth a new curve: it is slowed all
/// the way, which leaves its collisions where they are. Requires the measures of the path, unless
/// there was no time for them.
SlowedPlan meet_limits(const collision::Query& query, const PlanRequest& request,
                       const PreparedPlan& prepared, const CorrectedPlan& corrected,
                       const base::Deadline& deadline, PlanResult& result);

}  // namespace camway::planning
