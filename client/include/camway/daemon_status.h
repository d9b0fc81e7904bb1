// SPDX-License-Identifier: MIT
#pragma once

#include <camway/scene.h>
#include <camway/status.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace camway {

/// How long something took, counted on a logarithmic scale by the daemon.
struct Latency {
  std::int64_t count = 0;
  double sum_s = 0.0;
  /// What took longer than the bucket before allows, and no longer than this one does; see
  /// `latency_t`. May end early: the rest is 0.
  std::vector<std::int64_t> buckets;

  /// What a share `q` of all took at most, to a fifth of itself; 0 if nothing was counted, the
  /// longest time there is a bucket for (two minutes) if it was longer. [Limit: 0 <= q <= 1]
  double quantile_s(double q) const;
  /// Of what came since `before`, an earlier state of the same.
  Latency since(const Latency& before) const;
};

/// The daemon's heartbeat.
struct DaemonStatus {
  Status status = Status::kNoDaemon;
  std::string error;  ///< what failed and what to do about it; empty when `ok()`

  bool ok() const { return status == Status::kOk; }

  std::string version;
  double uptime_s = 0.0;
  std::int32_t num_workers = 0;
  std::int32_t queued_requests = 0;
  std::int32_t running_requests = 0;
  // Counted since the daemon's start:
  std::int64_t answered_requests = 0;
  std::int64_t repeated_requests = 0;  ///< repetitions of requests that were known already
  std::int64_t cache_hits = 0;         ///< of them: those that were answered already
  std::int64_t overloaded_requests = 0;
  std::int64_t malformed_messages = 0;
  std::int64_t dropped_answers = 0;  ///< for want of room; their clients ask again
  std::int64_t unsent_messages = 0;  ///< that LCM did not take
  std::int64_t request_pages_asked_again = 0;
  std::int64_t answer_pages_asked_again = 0;
  std::int64_t scene_changes = 0;
  // Not trusted, where the daemon checks signatures:
  std::int64_t unsigned_messages = 0;
  std::int64_t broken_envelopes = 0;
  std::int64_t unknown_key_messages = 0;
  std::int64_t altered_messages = 0;
  std::int64_t stale_messages = 0;
  std::int64_t replayed_messages = 0;
  std::int64_t crowded_messages = 0;
  std::int64_t received_messages = 0;
  std::int64_t received_bytes = 0;
  std::int64_t sent_messages = 0;
  std::int64_t sent_bytes = 0;
  /// By the number of their `Status`, repeated ones not counted again.
  std::array<std::int64_t, 16> plan_answers{};
  std::array<std::int64_t, 16> occupancy_answers{};
  std::array<std::int64_t, 16> scene_answers{};
  /// Of plan requests: from the receipt to the answer; of that until a worker began, and planning.
  Latency receipt_to_answer;
  Latency waiting;
  Latency planning;
  std::int64_t broken_paths = 0;   ///< times that a change broke a watched path
  std::int32_t watched_paths = 0;  ///< now

  bool signed_only = false;  ///< whether the daemon drops what is not signed with its keys

  std::int64_t failed_reloads = 0;       ///< of the configuration, since the daemon's start
  std::int64_t failed_reload_utime = 0;  ///< of the last: microseconds since 1970; 0 if none failed
  std::string failed_reload;             ///< why the last one failed; empty if none did
  bool reload_failed = false;            ///< whether no reload has succeeded since then

  std::int32_t total_scenes = 0;  ///< may exceed `scenes.size()` if there are very many
  std::vector<SceneInfo> scenes;  ///< in order of name
};

}  // namespace camway
