// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <camway/daemon_start_t.hpp>

#include "daemon/base/deadline.h"
#include "daemon/base/token_bucket.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "daemon/service/core/core_config.h"
#include "daemon/service/core/counters.h"
#include "daemon/service/log/limited_log.h"
#include "daemon/service/queue/worker_pool.h"
#include "daemon/service/transport/mailbox.h"
#include "daemon/service/transport/metered_transport.h"
#include "daemon/service/transport/outbox.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/utime.h"

namespace camway::service {

/// `planning::plan`, or a substitute in tests. Called on several threads at a time.
using Planner = std::function<planning::PlanResult(
    const scene::Snapshot&, const planning::PlanRequest&, const base::Deadline&)>;

using wire::utime_now;

/// State that all services share. Owned by `Service`.
///
/// Not thread-safe, except for the members `mailbox`, `workers`, `scenes` and `log`: all others,
/// and the functions, are for the loop thread.
struct Core {
  /// Requires that `inner_transport` and `scene_store` outlive this object.
  Core(Transport& inner_transport, const scene::SceneStore& scene_store, CoreConfig core_config,
       std::shared_ptr<Log> service_log);

  /// Publishes CAMWAY_ERROR about `message`, which came in on `channel` and whose sender is not
  /// known.
  void report_unanswerable(std::string_view channel, std::span<const std::uint8_t> message,
                           std::string_view reason);

  /// Decodes `message`, which came in on `channel`. If the message cannot be read or its client
  /// id is not valid, calls `refuse` as `on_malformed` does and returns nothing. Requires that the
  /// type begins with client_id and request_id.
  template <class Message, class Refuse>
  std::optional<Message> read(const std::string& channel, std::span<const std::uint8_t> message,
                              const Refuse& refuse);
  /// Does the same for messages whose senders get no answer: publishes CAMWAY_ERROR with the fault
  /// instead of calling `refuse`.
  template <class Message>
  std::optional<Message> read(const std::string& channel, std::span<const std::uint8_t> message);

  /// Counts and logs a message that cannot be read. If the message names its sender
  /// (`wire::Sender`), calls `refuse(sender, reason)`; otherwise publishes CAMWAY_ERROR. Does
  /// neither for messages beyond `CoreConfig::malformed_answers_per_s`.
  template <class Message, class Refuse>
  void on_malformed(const std::string& channel, std::span<const std::uint8_t> message,
                    std::string_view reason, const Refuse& refuse);

  /// Queues `job`. If the queue has no room, calls `Job::abandon` of `job`, or of the waiting job
  /// that `job` displaces, before it returns.
  void submit(Job job);

  /// Removes the jobs that have expired from the queue and calls `Job::abandon` of each.
  void expire_jobs();

  /// Returns the error text for the sender of a job that was refused for the reason `why`.
  [[nodiscard]] std::string refusal_text(Refusal why) const;

  /// Counts and logs a message that could not be read. Returns whether its sender may be answered.
  bool note_malformed(std::string_view channel, std::size_t size, std::string_view reason);

  const CoreConfig config;
  const daemon_start_t start;  ///< of this process, for every answer
  const wire::Channels channels;
  const scene::SceneStore& scenes;
  const std::shared_ptr<Log> log;
  MeteredTransport transport;
  Counters counters;
  LimitedLogs limited_log;
  base::TokenBucket malformed_answers;
  Outbox outbox;
  Mailbox mailbox;
  WorkerPool workers;
};

template <class Message, class Refuse>
std::optional<Message> Core::read(const std::string& channel, std::span<const std::uint8_t> message,
                                  const Refuse& refuse) {
  wire::Decoded<Message> decoded = wire::decode<Message>(message);
  const std::string type = Message::getTypeName();
  if (!decoded.message) {
    on_malformed<Message>(channel, message, decoded.fault.text(type), refuse);
    return std::nullopt;
  }
  if (!wire::is_client_id(decoded.message->client_id)) {
    on_malformed<Message>(channel, message, type + ".client_id: is not of [A-Za-z0-9_-]{1,32}",
                          refuse);
    return std::nullopt;
  }
  return std::move(decoded.message);
}

template <class Message>
std::optional<Message> Core::read(const std::string& channel,
                                  std::span<const std::uint8_t> message) {
  return read<Message>(channel, message, [&](const wire::Sender&, std::string_view reason) {
    report_unanswerable(channel, message, reason);
  });
}

template <class Message, class Refuse>
void Core::on_malformed(const std::string& channel, std::span<const std::uint8_t> message,
                        std::string_view reason, const Refuse& refuse) {
  if (!note_malformed(channel, message.size(), reason)) return;
  if (const auto sender = wire::peek_sender(wire::layout_of<Message>(), message)) {
    refuse(*sender, reason);
  } else {
    report_unanswerable(channel, message, reason);
  }
}

}  // namespace camway::service
