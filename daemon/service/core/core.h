// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "daemon/base/deadline.h"
#include "daemon/planning/request.h"
#include "daemon/planning/result.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "daemon/service/core/config.h"
#include "daemon/service/core/counters.h"
#include "daemon/service/log/limited_log.h"
#include "daemon/service/queue/worker_pool.h"
#include "daemon/service/transport/mailbox.h"
#include "daemon/service/transport/metered_transport.h"
#include "daemon/service/transport/outbox.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"

namespace camway::service {

/// `planning::plan`, or a substitute in tests. Called on several threads at a time.
using Planner = std::function<planning::PlanResult(
    const scene::Snapshot&, const planning::PlanRequest&, const collision::Deadline&)>;

/// Returns the time in microseconds since 1970.
std::int64_t utime_now();

/// State that all services share. Owned by `Service`. All members except `mailbox`, `workers`,
/// `scenes` and `log` belong to the loop thread.
struct Core {
  Core(Transport& inner_transport, const scene::SceneStore& scene_store, CoreConfig core_config,
       std::shared_ptr<Log> service_log);

  /// Publishes CAMWAY_ERROR about `message` on `channel`, whose sender is not known.
  void report_unanswerable(std::string_view channel, std::span<const std::uint8_t> message,
                           std::string_view reason);

  /// Queues `job`. Abandons, before it returns, the job that the queue refused or dropped.
  void submit(Job job);

  /// Abandons the jobs that waited for too long.
  void expire_jobs();

  /// Returns the message to the sender of a job that is refused.
  [[nodiscard]] std::string refusal_text(Refusal why) const;

  /// Counts and logs a message that could not be read. Returns whether its sender may be answered.
  bool note_malformed(std::string_view channel, std::size_t size, std::string_view reason);

  const CoreConfig config;
  const wire::Channels channels;
  const scene::SceneStore& scenes;
  const std::shared_ptr<Log> log;
  MeteredTransport transport;
  Counters counters;
  LimitedLogs limited_log;
  TokenBucket malformed_answers;
  Outbox outbox;
  Mailbox mailbox;
  WorkerPool workers;
};

}  // namespace camway::service
