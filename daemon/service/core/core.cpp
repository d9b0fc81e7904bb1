// SPDX-License-Identifier: MIT
#include "daemon/service/core/core.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

#include <camway/error_t.hpp>

#include "daemon/messages/text.h"

namespace camway::service {

namespace {

daemon_start_t new_start(bool is_durable) {
  std::random_device random;
  daemon_start_t start{};
  start.durable = is_durable;
  // Halves of 31 bits, so that languages without unsigned numbers show it alike.
  constexpr std::uint32_t kHalf = 0x7fffffff;
  start.id = static_cast<std::int64_t>(random() & kHalf) << 31 |
             static_cast<std::int64_t>(random() & kHalf) | 1;
  return start;
}

}  // namespace

Core::Core(Transport& inner_transport, const scene::SceneStore& scene_store, CoreConfig core_config,
           std::shared_ptr<Log> service_log)
    : config(std::move(core_config)),
      start(new_start(config.is_durable)),
      channels{config.prefix},
      scenes(scene_store),
      log(std::move(service_log)),
      transport(inner_transport),
      limited_log(log, config.log_limits),
      malformed_answers(config.malformed_answers_per_s, config.malformed_answers_per_s),
      outbox(transport, config.answers),
      mailbox(transport),
      workers(std::max(config.workers, config.most_jobs), config.queue) {
  workers.allow(config.workers);
}

void Core::submit(Job job) {
  if (std::optional<FairQueue::Refused> refused = workers.submit(std::move(job))) {
    refused->job.abandon(refused->why);
  }
}

void Core::expire_jobs() {
  for (const Job& job : workers.take_expired(Job::Clock::now())) job.abandon(Refusal::kExpired);
}

std::string Core::refusal_text(Refusal why) const {
  switch (why) {
    case Refusal::kClientFull:
      return fmt::format(
          "{} requests of this client wait already "
          "(queue.requests_of_a_client); send it again later",
          config.queue.jobs_of_a_client);
    case Refusal::kStopping:
      return "the daemon is stopping";
    case Refusal::kQueueFull:
    case Refusal::kExpired:
    case Refusal::kCancelled:
      break;
  }
  return fmt::format(
      "all {} workers are busy and {} requests wait (queue.requests); send it again later",
      workers.allowed(), config.queue.jobs);
}

bool Core::note_malformed(std::string_view channel, std::size_t size, std::string_view reason) {
  ++counters.malformed;
  limited_log.malformed.write("malformed message",
                              {{"channel", channel},
                               {"bytes", size},
                               {"reason", messages::clipped(reason, wire::kMaxTextBytes)}});
  return malformed_answers.take(base::TokenBucket::Clock::now());
}

void Core::report_unanswerable(std::string_view channel, std::span<const std::uint8_t> message,
                               std::string_view reason) {
  error_t error{};
  error.utime = utime_now();
  error.channel = channel;
  error.size_bytes = static_cast<std::int64_t>(message.size());
  error.message = messages::clipped(reason, wire::kMaxTextBytes);
  outbox.add(channels.error(), one_page(wire::encode(error)), {}, Outbox::Kind::kRefusal);
}

}  // namespace camway::service
