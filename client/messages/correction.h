// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <optional>
#include <string>
#include <vector>

#include <camway/plan_response_t.hpp>

namespace camway {

/// Copies the members of `page` about correction that are not lists: measures, bounds, scales, the
/// deadline flag, and the head of a proof that no path exists.
void read_correction_head(const plan_response_t& page, PlanResponse& response);

/// Appends the lists of `page` about correction. Returns the fault of the first element that is not
/// valid, or nothing.
std::optional<std::string> append_correction_lists(const plan_response_t& page,
                                                   PlanResponse& response);

}  // namespace camway
