// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "daemon/planning/request.h"
#include "daemon/service/answer_cache.h"
#include "daemon/service/fair_queue.h"
#include "daemon/service/limited_log.h"
#include "daemon/service/map_exports.h"
#include "daemon/service/outbox.h"
#include "daemon/service/scene_rules.h"
#include "daemon/service/uploads.h"
#include "daemon/service/wire_convert.h"
#include "daemon/service/wire_pages.h"
#include "lcmtypes/wire_layout.h"

namespace camway::service {

inline constexpr std::size_t kMaxQueueCapacity = 100'000;
inline constexpr int kMaxWorkers = 256;

/// What clients may leave with the daemon to be watched.
struct WatchLimits {
  std::size_t paths = 16384;                         ///< of all clients [Limit: 0 <= value]
  std::size_t paths_of_a_client = 16384;             ///< likewise
  std::size_t bytes = std::size_t{512} << 20;        ///< of paths and requests together
  std::chrono::milliseconds longest_lease{300'000};  ///< without a word from the client
};

/// How the service behaves. Every default works; other values keep the limits, which whoever sets
/// them sees to.
struct ServiceConfig {
  std::string prefix = "CAMWAY";  ///< of all channels; `--prefix` [Limit: wire::is_prefix(value)]
  int workers = 1;                ///< `--workers` [Limit: 1 <= value <= kMaxWorkers]
  /// Requests that wait for a worker; `--queue`, `--client-queue`
  /// [Limit: 1 <= value <= kMaxQueueCapacity]
  FairQueue::Limits queue;
  /// Bytes of the plan requests that wait or are planned.
  std::size_t request_bytes = std::size_t{256} << 20;
  /// Of an answer; `queue.answer_pages` [Limit: 1 <= value <= wire::kMaxResponsePages]
  int answer_pages = wire::kMaxResponsePages;
  Outbox::Limits answers;  ///< that wait to be sent; `queue.answers` and others
  /// Answers to messages that cannot be read, to whomever, and at once: they must not keep those
  /// that others wait for. [Limit: 1 <= value]
  double malformed_answers_per_s = 100.0;
  DeadlineLimits deadline;            ///< of plan requests
  DeadlineLimits occupancy_deadline;  ///< of batches of occupancy queries
  /// Of changes of scenes: generous, as a large scene takes its time.
  DeadlineLimits change_deadline{.default_s = 600.0, .max_s = 3600.0};
  /// Keyframes of a request. [Limit: 2 <= value <= planning::kMaxKeyframes]
  std::size_t keyframes = planning::kMaxKeyframes;
  PageAssembly<plan_request_t>::Limits assembly;
  AnswerCache::Limits cache;
  /// Messages that may wait in LCM between two turns of the loop, for each kind of request. Large
  /// enough for the longest request in pages; the loop only checks and queues, so it drains fast.
  int subscription_capacity = 1024;
  SceneRules scene_rules;
  Uploads::Limits uploads;     ///< `scenes.uploads` and others
  MapExports::Limits exports;  ///< `scenes.exports` and others
  /// Changes of different scenes that are made at the same time; `scenes.workers`
  /// [Limit: 1 <= value <= kMaxWorkers]
  int scene_workers = 4;
  FairQueue::Limits changes;  ///< of scenes that wait for the ones before them
  WatchLimits watches;        ///< `watch.paths` and others
  std::chrono::milliseconds heartbeat_period{1000};
  /// How long to ask, before serving, whether another daemon serves with this prefix (see
  /// `PrefixClaim`); 0: not at all. [Limit: 0 <= value]
  std::chrono::milliseconds claim_window{0};
  /// How long a stop waits for what is being planned. [Limit: 0 <= value]
  std::chrono::milliseconds drain_limit{15'000};
  LimitedLog::Limits log_limits;  ///< of what clients can provoke; `log.lines_per_s` and others
};

}  // namespace camway::service
