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

/// Configuration of the core that all services share. Every default works; values that are set must
/// keep the limits, which is not checked here.
struct CoreConfig {
  /// Prefix of all channels; `--prefix` [Limit: wire::is_prefix(value)]
  std::string prefix = "CAMWAY";
  bool is_durable = false;  ///< whether the scenes outlive the daemon
  int workers = 1;          ///< `--workers` [Limit: 1 <= value <= kMaxWorkers]
  /// Threads that answer plan requests, if they only wait for other processes that plan: then
  /// `Service::allow` says how many work. Not below `workers`; 0: `workers`.
  int most_jobs = 0;
  /// Requests that wait for a worker; `--queue`, `--client-queue`
  /// [Limit: 1 <= value <= kMaxQueueCapacity]
  FairQueue::Limits queue;
  Outbox::Limits answers;  ///< answers that wait to be sent; `queue.answers` and others
  /// Largest number of answers per second to messages that cannot be read, over all senders, so
  /// that they do not delay other answers. [Limit: 1 <= value]
  double malformed_answers_per_s = 100.0;
  AnswerCache::Limits cache;  ///< for answers to plan requests, and again to scene requests
  /// Messages that may wait in LCM between two rounds of the loop, for each channel. Large enough
  /// for the longest request in pages; the loop only checks and queues, so it drains fast.
  int subscription_capacity = 1024;
  std::chrono::milliseconds heartbeat_period{1000};
  /// How long a start asks whether another daemon has the prefix (`PrefixClaim`); 0: never.
  /// [Limit: 0 <= value]
  std::chrono::milliseconds claim_window{0};
  /// How long a stop waits for planning that is running. [Limit: 0 <= value]
  std::chrono::milliseconds drain_limit{15'000};
  LimitedLog::Limits log_limits;  ///< for lines clients can provoke; `log.lines_per_s` and others
};

}  // namespace camway::service
