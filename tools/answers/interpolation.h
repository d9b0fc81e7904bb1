// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "daemon/planning/request/request.h"

namespace camway::tools {

/// Returns the path through the keyframes of a request as `{"segments": [...]}`, at the times that
/// its answer has: as it is before anything is checked, repaired or corrected. No scene has a part
/// in it. Requires a request that `planning::validate` accepts. Thread-safe.
base::Result<std::string> interpolated_text(const planning::PlanRequest& request);

}  // namespace camway::tools
