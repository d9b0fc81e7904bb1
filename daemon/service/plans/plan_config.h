// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "daemon/messages/convert.h"
#include "daemon/messages/pages.h"
#include "daemon/planning/request.h"
#include "lcmtypes/wire/layout.h"

namespace camway::service {

/// How plan requests are answered.
struct PlanConfig {
  /// Bytes of the plan requests that wait or are planned.
  std::size_t request_bytes = std::size_t{256} << 20;
  /// Of an answer; `queue.answer_pages` [Limit: 1 <= value <= wire::kMaxResponsePages]
  int answer_pages = wire::kMaxResponsePages;
  DeadlineLimits deadline;  ///< of plan requests
  /// Keyframes of a request. [Limit: 2 <= value <= planning::kMaxKeyframes]
  std::size_t keyframes = planning::kMaxKeyframes;
  PageAssembly<plan_request_t>::Limits assembly;
};

}  // namespace camway::service
