// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/collision/query.h"
#include "daemon/motion/path/time_origin.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/planning/stages/correct.h"
#include "daemon/planning/stages/fixed_place.h"
#include "daemon/planning/stages/meet_limits.h"

namespace camway::planning {

/// The outcomes of the stages of a plan.
struct Outcomes {
  const PlanRequest& request;
  const collision::Query& query;
  const motion::TimeOrigin& origin;
  const CorrectedPlan& corrected;
  const SlowedPlan& slowed;
  bool is_searched;  ///< whether the path as interpolated was searched for collisions
  /// The place that keeps the objective `kSafest` from more room, if there is one.
  const std::optional<FixedPlace>& limit;
};

/// Sets the status of `result`, and the message that gives the reason. Requires that `result` has a
/// path, its remaining collisions, its certificate and its corrections.
void set_status(const Outcomes& outcomes, PlanResult& result);

}  // namespace camway::planning
