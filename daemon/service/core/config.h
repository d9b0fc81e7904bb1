// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "daemon/service/core/answer_cache.h"
#include "daemon/service/log/limited_log.h"
#include "daemon/service/queue/fair_queue.h"
#include "daemon/service/transport/outbox.h"

namespace camway::service {

inline constexpr std::size_t kMaxQueueCapacity = 100'000;
inline constexpr int kMaxWorkers = 256;

/// How the core that all services share behaves. Every default works; other values keep the limits,
/// which whoever sets them sees to.
struct CoreConfig {
  std::string prefix = "CAMWAY";  ///< of all channels; `--prefix` [Limit: wire::is_prefix(value)]
  int workers = 1;                ///< `--workers` [Limit: 1 <= value <= kMaxWorkers]
  /// Requests that wait for a worker; `--queue`, `--client-queue`
  /// [Limit: 1 <= value <= kMaxQueueCapacity]
  FairQueue::Limits queue;
  Outbox::Limits answers;  ///< that wait to be sent; `queue.answers` and others
  /// Answers to messages that cannot be read, to whomever, and at once: they must not keep those
  /// that others wait for. [Limit: 1 <= value]
  double malformed_answers_per_s = 100.0;
  AnswerCache::Limits cache;  ///< of the answers to plan requests, and of those to scene requests
  /// Messages that may wait in LCM between two turns of the loop, for each kind of request. Large
  /// enough for the longest request in pages; the loop only checks and queues, so it drains fast.
  int subscription_capacity = 1024;
  std::chrono::milliseconds heartbeat_period{1000};
  /// How long to ask, before serving, whether another daemon serves with this prefix (see
  /// `PrefixClaim`); 0: not at all. [Limit: 0 <= value]
  std::chrono::milliseconds claim_window{0};
  /// How long a stop waits for what is being planned. [Limit: 0 <= value]
  std::chrono::milliseconds drain_limit{15'000};
  LimitedLog::Limits log_limits;  ///< of what clients can provoke; `log.lines_per_s` and others
};

}  // namespace camway::service
