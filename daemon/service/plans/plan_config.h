// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "daemon/messages/deadline_limits.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/request/validate.h"
#include "lcmtypes/wire/layout.h"
#include "lcmtypes/wire/page_assembly.h"

namespace camway::service {

/// Configuration of plan requests.
struct PlanConfig {
  /// Size of the plan requests that wait or are being planned.
  std::size_t request_bytes = std::size_t{256} << 20;
  /// Pages of an answer; `queue.answer_pages` [Limit: 1 <= value <= wire::kMaxResponsePages]
  int answer_pages = wire::kMaxResponsePages;
  messages::DeadlineLimits deadline;  ///< deadlines of plan requests
  /// Keyframes of a request. [Limit: 2 <= value <= planning::kMaxKeyframes]
  std::size_t keyframes = planning::kMaxKeyframes;
  wire::PageAssembly<plan_request_t>::Limits assembly;
};

}  // namespace camway::service
