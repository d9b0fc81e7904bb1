// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <string>

#include "daemon/planning/request.h"

namespace camway::tools {

/// A request as read from a file, in the form in which the client sends it to a daemon that holds
/// its scene under the name `scene`. All options are sent explicitly, so the daemon's defaults play
/// no part.
PlanRequest to_client_request(const planning::PlanRequest& request, const std::string& scene);

/// Bounds as the client has them, and back.
Bounds to_client_bounds(const geometry::Bounds& bounds);
geometry::Bounds from_client_bounds(const Bounds& bounds);

}  // namespace camway::tools
