// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>

#include <cstdint>
#include <string>
#include <vector>

#include <camway/plan_progress_t.hpp>
#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>

#include "lcmtypes/wire/pages.h"

namespace camway {

/// Writes a request except its ids and its time of sending.
void convert(const PlanRequest& mine, plan_request_t& wire);
/// Reads a whole answer except its path.
void convert(const plan_response_t& wire, PlanResponse& mine);
/// Reads a progress report. A stage that this client does not know becomes kWaiting.
void convert(const plan_progress_t& wire, PlanProgress& mine);

/// Returns the pages of a request, each of at most `wire::kMaxMessageBytes`. Requires a request
/// without `fault_in_form`.
std::vector<wire::Bytes> to_pages(const PlanRequest& request, const std::string& client_id,
                                  std::int64_t request_id);

}  // namespace camway
