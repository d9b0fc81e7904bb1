// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan_request_t.hpp>

#include "daemon/planning/request/request.h"

namespace camway::messages {

/// Returns how the message `wire` spells the members of a request, for messages about it:
/// "options.limits.turn_rate" is "limits.turn_rate_rad_per_s", "keyframes[3].time" is
/// "keyframes[3].time_s".
/// Keeps no reference.
planning::FieldSpelling wire_spelling(const plan_request_t& wire);

}  // namespace camway::messages
