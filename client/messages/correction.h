// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <optional>
#include <string>
#include <vector>

#include <camway/plan_response_t.hpp>

namespace camway {

/// Reads what the head of `page` says of correction: measures, scales, and whether there is a proof
/// that no path exists.
void read_correction_head(const plan_response_t& page, PlanResponse& response);

/// Appends the page's lists of it. Why that cannot be, for the first element that makes no sense.
std::optional<std::string> append_correction_lists(const plan_response_t& page,
                                                   PlanResponse& response);

}  // namespace camway
