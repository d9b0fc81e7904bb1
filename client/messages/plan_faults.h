// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <optional>
#include <string>

#include <camway/plan_response_t.hpp>

namespace camway {

/// Returns the fault of a request that cannot be sent (the field and its limit), or nothing. The
/// daemon checks the values, such as a zero quaternion.
std::optional<std::string> fault_in_form(const PlanRequest& request);

/// Returns why the path and the report of an answer make no sense; nothing if they do. `whole`: all
/// pages of the answer, joined.
std::optional<std::string> fault_in_answer(const plan_response_t& whole);

}  // namespace camway
