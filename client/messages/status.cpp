// SPDX-License-Identifier: MIT
#include "client/messages/status.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include <camway/status_t.hpp>

#include "client/messages/scene.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/latency_buckets.h"

namespace camway {
namespace {

Latency from_wire(const latency_t& wire) {
  const std::size_t known = std::min(wire.buckets.size(), wire::kLatencyBuckets);
  const auto end = wire.buckets.begin() + static_cast<std::ptrdiff_t>(known);
  return {wire.count, wire.sum_s, {wire.buckets.begin(), end}};
}

void read_counters(const status_t& wire, DaemonStatus& status) {
  status.answered_requests = wire.answered_requests;
  status.repeated_requests = wire.repeated_requests;
  status.cache_hits = wire.cache_hits;
  status.overloaded_requests = wire.overloaded_requests;
  status.malformed_messages = wire.malformed_messages;
  status.dropped_answers = wire.dropped_answers;
  status.unsent_messages = wire.unsent_messages;
  status.request_pages_asked_again = wire.request_pages_asked_again;
  status.answer_pages_asked_again = wire.answer_pages_asked_again;
  status.scene_changes = wire.scene_changes;
  status.unsigned_messages = wire.unsigned_messages;
  status.broken_envelopes = wire.broken_envelopes;
  status.unknown_key_messages = wire.unknown_key_messages;
  status.altered_messages = wire.altered_messages;
  status.stale_messages = wire.stale_messages;
  status.replayed_messages = wire.replayed_messages;
  status.crowded_messages = wire.crowded_messages;
  status.received_messages = wire.received_messages;
  status.received_bytes = wire.received_bytes;
  status.sent_messages = wire.sent_messages;
  status.sent_bytes = wire.sent_bytes;
  std::copy(std::begin(wire.plan_answers), std::end(wire.plan_answers),
            status.plan_answers.begin());
  std::copy(std::begin(wire.occupancy_answers), std::end(wire.occupancy_answers),
            status.occupancy_answers.begin());
  std::copy(std::begin(wire.scene_answers), std::end(wire.scene_answers),
            status.scene_answers.begin());
}

DaemonStatus from_wire(const status_t& wire) {
  DaemonStatus status;
  status.status = Status::kOk;
  status.version = wire.version;
  status.uptime_s = wire.uptime_s;
  status.num_workers = wire.num_workers;
  status.queued_requests = wire.queued_requests;
  status.running_requests = wire.running_requests;
  read_counters(wire, status);
  status.receipt_to_answer = from_wire(wire.receipt_to_answer);
  status.waiting = from_wire(wire.waiting);
  status.planning = from_wire(wire.planning);
  status.watched_paths = wire.watched_paths;
  status.broken_paths = wire.broken_paths;
  status.signed_only = wire.signed_only != 0;
  status.failed_reloads = wire.failed_reloads;
  status.failed_reload_utime = wire.failed_reload_utime;
  status.failed_reload = wire::printable(wire.failed_reload);
  status.reload_failed = wire.reload_failed != 0;
  status.total_scenes = wire.total_scenes;
  for (const scene_info_t& scene : wire.scenes) status.scenes.push_back(from_wire(scene));
  return status;
}

}  // namespace

std::optional<DaemonStatus> read_status(std::span<const std::uint8_t> bytes) {
  const wire::Decoded<status_t> decoded = wire::decode<status_t>(bytes);
  if (!decoded.message) return std::nullopt;
  return from_wire(*decoded.message);
}

}  // namespace camway
