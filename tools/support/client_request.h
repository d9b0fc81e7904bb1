// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <string>

#include "daemon/planning/request/request.h"

namespace camway::tools {

/// Returns a request from a file as the client sends it to a daemon whose scene has the name
/// `scene`. Every option is set, so the daemon's defaults have no effect.
PlanRequest to_client_request(const planning::PlanRequest& request, const std::string& scene);

Bounds to_client_bounds(const geometry::Bounds& bounds);

}  // namespace camway::tools
