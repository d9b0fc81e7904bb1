// SPDX-License-Identifier: MIT
#include "daemon/service/heartbeat.h"

#include <algorithm>
#include <iterator>

#include "daemon/messages/scene.h"
#include "daemon/version/version.h"

namespace camway::service {
namespace {

template <std::size_t kSize>
void copy(const AnswerCounts& from, std::int64_t (&to)[kSize]) {
  static_assert(kSize == AnswerCounts::kStatuses);
  std::copy(from.counts().begin(), from.counts().end(), std::begin(to));
}

void add_counters(const Core& core, status_t& status) {
  const Counters& counters = core.counters;
  status.answered_requests = counters.answered;
  status.repeated_requests = counters.repeated;
  status.cache_hits = counters.cache_hits;
  status.overloaded_requests = counters.overloaded;
  status.malformed_messages = counters.malformed;
  status.dropped_answers = core.outbox.dropped();
  status.request_pages_asked_again = counters.request_pages_asked_again;
  status.answer_pages_asked_again = counters.answer_pages_asked_again;
  status.scene_changes = counters.scene_changes;
  status.watched_paths = counters.watched_paths;
  status.broken_paths = counters.broken_paths;
  copy(counters.plan_answers, status.plan_answers);
  copy(counters.occupancy_answers, status.occupancy_answers);
  copy(counters.scene_answers, status.scene_answers);
  status.receipt_to_answer = counters.receipt_to_answer.to_wire();
  status.waiting = counters.waiting.to_wire();
  status.planning = counters.planning.to_wire();
}

void add_traffic(const MeteredTransport::Traffic& traffic, status_t& status) {
  status.unsent_messages = traffic.unsent_messages;
  status.received_messages = traffic.received_messages;
  status.received_bytes = traffic.received_bytes;
  status.sent_messages = traffic.sent_messages;
  status.sent_bytes = traffic.sent_bytes;
}

void add_scenes(const scene::SceneStore& store, status_t& status) {
  const std::vector<std::shared_ptr<const scene::Snapshot>> scenes = store.list();
  status.total_scenes = static_cast<std::int32_t>(scenes.size());
  std::size_t size = static_cast<std::size_t>(status.getEncodedSize());
  for (const std::shared_ptr<const scene::Snapshot>& snapshot : scenes) {
    scene_info_t info = messages::scene_info_of(*snapshot);
    size += static_cast<std::size_t>(info._getEncodedSizeNoHash());
    if (size > wire::kMaxMessageBytes) break;
    status.scenes.push_back(std::move(info));
  }
  status.num_scenes = static_cast<std::int32_t>(status.scenes.size());
}

}  // namespace

void fit_message(status_t& status) {
  auto size = static_cast<std::size_t>(status.getEncodedSize());
  while (size > wire::kMaxMessageBytes && !status.scenes.empty()) {
    size -= static_cast<std::size_t>(status.scenes.back()._getEncodedSizeNoHash());
    status.scenes.pop_back();
  }
  status.num_scenes = static_cast<std::int32_t>(status.scenes.size());
}

status_t make_status(const Core& core, std::chrono::duration<double> uptime) {
  status_t status{};
  status.utime = utime_now();
  status.daemon_start = core.start;
  status.version = kVersion;
  status.uptime_s = uptime.count();
  status.num_workers = core.workers.allowed();
  status.role = "alone";
  status.queued_requests = static_cast<std::int32_t>(core.workers.queued());
  status.running_requests = static_cast<std::int32_t>(core.workers.running());
  add_counters(core, status);
  add_traffic(core.transport.traffic(), status);
  add_scenes(core.scenes, status);
  return status;
}

}  // namespace camway::service
