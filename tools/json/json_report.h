// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/planning/result.h"
#include "tools/json/json_document.h"

namespace camway::tools {

/// Reads the fields of a response about correction into `result`, each if it is there:
/// `corrections`, `measures`, `near_scale`, `time_scale`, `slowed`, `keyframe_faults`,
/// `infeasibility`.
void read_report(const Field& root, planning::PlanResult& result);

}  // namespace camway::tools
