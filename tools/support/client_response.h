// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include "daemon/planning/result/result.h"

namespace camway::tools {

/// Returns the result in a daemon's answer, as `planning::plan` has it. Requires a status of the
/// daemon that planning has (`has_result`). Missing, because messages do not carry it, are
/// `Timing::load_scene_ms`, `shut_in`, `KeyframeFault::leaves_bounds`, the numbers of features
/// (their names are there), and the witnesses in `corrections`.
planning::PlanResult to_plan_result(const PlanResponse& response);

/// Whether the status is one of planning, so that the answer has a result.
bool has_result(Status status);

}  // namespace camway::tools
