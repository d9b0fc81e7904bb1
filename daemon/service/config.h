// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "daemon/service/answer_cache.h"
#include "daemon/service/fair_queue.h"
#include "daemon/service/wire_convert.h"
#include "daemon/service/wire_pages.h"

namespace camway::service {

inline constexpr std::size_t kMaxQueueCapacity = 100'000;
inline constexpr int kMaxWorkers = 256;

/// How the service behaves. Every default works.
struct ServiceConfig {
  std::string prefix = "CAMWAY";  ///< of all channels; `--prefix` [Limit: wire::is_prefix(value)]
  int workers = 1;                ///< `--workers` [Limit: 1 <= value <= kMaxWorkers]
  /// Requests that wait for a worker; `--queue`, `--client-queue`
  /// [Limit: 1 <= value <= kMaxQueueCapacity]
  FairQueue::Limits queue;
  DeadlineLimits deadline;
  PageAssembly<plan_request_t>::Limits assembly;
  AnswerCache::Limits cache;
  /// Messages that may wait in LCM between two turns of the loop, for each kind of request. Large
  /// enough for the longest request in pages; the loop only checks and queues, so it drains fast.
  int subscription_capacity = 1024;
  std::chrono::milliseconds heartbeat_period{1000};
  /// How long a stop waits for what is being planned. [Limit: 0 <= value]
  std::chrono::milliseconds drain_limit{15'000};
  /// Warnings of one kind are logged at most once in this time, with the number left out.
  std::chrono::milliseconds warning_period{5000};

  /// What is wrong with the values, or an empty text.
  [[nodiscard]] std::string fault() const;
};

}  // namespace camway::service
