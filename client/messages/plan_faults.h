// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <optional>
#include <string>

namespace camway {

/// Returns the fault of a request that cannot be sent (the field and its limit), or nothing. The
/// daemon checks the values, such as a zero quaternion.
std::optional<std::string> fault_in_form(const PlanRequest& request);

}  // namespace camway
