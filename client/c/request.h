// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <camway/plan.h>

namespace camway::c {

/// Returns the request of a caller. Throws `Refusal` if it is NULL, if an array or a text is
/// missing, or if a choice is none; all else is for the daemon to check.
PlanRequest request_of(const camway_plan_request* given);

}  // namespace camway::c
