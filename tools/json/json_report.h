// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/result.h"
#include "tools/json/json_document.h"

namespace camway::tools {

/// Reads what a response says of correction and of what stood in its way, whatever is there of it:
/// `corrections`, `measures`, `near_scale`, `time_scale`, `slowed`, `keyframe_faults`, `infeasibility`.
void read_report(const Field& root, planning::PlanResult& result);

}  // namespace camway::tools
