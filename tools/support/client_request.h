// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <string>

#include "daemon/planning/request/request.h"

namespace camway::tools {

/// Returns a request from a file as the client sends it to a daemon whose scene has the name
/// `scene`. Every option is set, so the daemon's defaults have no effect.
PlanRequest to_client_request(const planning::PlanRequest& request, const std::string& scene);

/// Convert bounds into the client's type and back.
Bounds to_client_bounds(const geometry::Bounds& bounds);
geometry::Bounds from_client_bounds(const Bounds& bounds);

}  // namespace camway::tools
