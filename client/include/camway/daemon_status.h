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

/// A histogram of durations with logarithmic buckets, counted since the daemon's start.
struct Latency {
  std::int64_t count = 0;  ///< number of durations
  double sum_s = 0.0;      ///< sum of all durations
  /// Bucket i counts the durations of at most 10 µs · 2^(i/4) that are longer than the bound of
  /// bucket i-1; bucket 95 has no upper bound. `buckets` leaves out empty buckets at its end.
  std::vector<std::int64_t> buckets;

  /// Returns the upper bound of the bucket that holds the quantile `q`, at most a fifth above it.
  /// Returns 0 for an empty histogram, and the last finite bound (two minutes) for longer
  /// durations. [Limit: 0 <= q <= 1]
  double quantile_s(double q) const;
  /// Returns the histogram of the durations that were added since `before`, an earlier state.
  Latency since(const Latency& before) const;
};

/// A planner of a fleet, as a front sees it.
struct FleetPlanner {
  std::string id;
  std::string host;  ///< name of its machine
  std::int32_t pid = 0;
  std::string version;
  std::int32_t workers = 0;  ///< jobs that it can run at the same time
  std::int32_t running = 0;  ///< jobs that it runs
  bool is_behind = false;    ///< whether it has not read all of the log that the front has read
  /// Whether it gets no jobs, because its version is not that of the front.
  bool is_other_version = false;
  double silent_s = 0.0;  ///< time since the front last heard it
};

/// The heartbeat of a daemon. Counters begin at the daemon's start.
struct DaemonStatus {
  Status status = Status::kNoDaemon;
  std::string error;  ///< the failure and its remedy; empty when `ok()`

  bool ok() const { return status == Status::kOk; }

  DaemonStart daemon_start;
  std::string version;
  double uptime_s = 0.0;
  std::int32_t num_workers = 0;          ///< requests that can be planned at the same time
  std::int32_t queued_requests = 0;      ///< requests that wait for a worker now
  std::int32_t running_requests = 0;     ///< requests that are being planned now
  std::int64_t answered_requests = 0;    ///< answers sent, repeated ones included
  std::int64_t repeated_requests = 0;    ///< requests that were known already
  std::int64_t cache_hits = 0;           ///< repeated requests that were answered from the cache
  std::int64_t overloaded_requests = 0;  ///< requests refused because the queue was full
  std::int64_t malformed_messages = 0;   ///< messages that could not be read
  std::int64_t dropped_answers = 0;      ///< answers dropped because too many waited to be sent
  std::int64_t unsent_messages = 0;      ///< messages that LCM did not accept
  std::int64_t request_pages_asked_again = 0;  ///< missing pages that the daemon asked for
  std::int64_t answer_pages_asked_again = 0;   ///< missing pages that clients asked for
  std::int64_t scene_changes = 0;              ///< revisions that clients made
  // Messages that failed the check of signatures, by reason; 0 without keys.
  std::int64_t unsigned_messages = 0;     ///< without a signature
  std::int64_t broken_envelopes = 0;      ///< with an envelope that cannot be read
  std::int64_t unknown_key_messages = 0;  ///< signed with a key that the daemon does not have
  std::int64_t altered_messages = 0;      ///< with a wrong signature
  std::int64_t stale_messages = 0;        ///< with a time outside the window
  std::int64_t replayed_messages = 0;     ///< received before
  /// Messages of new senders while the daemon already remembers as many senders as it can
  /// (`auth.senders`).
  std::int64_t crowded_messages = 0;
  std::int64_t received_messages = 0;
  std::int64_t received_bytes = 0;
  std::int64_t sent_messages = 0;
  std::int64_t sent_bytes = 0;
  std::array<std::int64_t, 16> plan_answers{};       ///< answers by `Status`, without repeated ones
  std::array<std::int64_t, 16> occupancy_answers{};  ///< answers by `Status`, without repeated ones
  std::array<std::int64_t, 16> scene_answers{};      ///< answers by `Status`, without repeated ones
  Latency receipt_to_answer;       ///< plan requests: time from the receipt to the answer
  Latency waiting;                 ///< plan requests: time from the receipt until a worker begins
  Latency planning;                ///< plan requests: time of the planning
  std::int64_t broken_paths = 0;   ///< number of times that a change broke a watched path
  std::int32_t watched_paths = 0;  ///< paths that are watched now

  bool signed_only = false;  ///< whether the daemon drops messages without a valid signature

  std::int64_t failed_reloads = 0;       ///< reloads of the configuration that failed
  std::int64_t failed_reload_utime = 0;  ///< time of the last, microseconds since 1970; 0 if none
  std::string failed_reload;             ///< reason of the last failure; empty if there was none
  bool reload_failed = false;            ///< whether no reload has succeeded since that failure

  std::string recording_folder;     ///< folder into which the daemon records; empty if it does not
  std::int64_t recorded_bytes = 0;  ///< bytes that were recorded
  std::int64_t not_recorded = 0;    ///< messages and changes of scenes left out of the recording
  /// Why something was left out within the last half minute; empty if nothing was.
  std::string recording_trouble;

  std::string role;                    ///< "alone", or "front" of a fleet of planners
  bool log_in_touch = false;           ///< whether the fleet's log of scenes can be reached
  std::int64_t jobs_sent_again = 0;    ///< requests that were sent to planners again
  std::int64_t differing_answers = 0;  ///< requests to which two planners gave different answers
  std::int64_t planned_here = 0;       ///< requests that a front planned by itself
  std::vector<FleetPlanner> planners;  ///< of a front: heard within a minute, by id

  /// Number of scenes of the daemon. `scenes` may list fewer, because the list must fit one
  /// message.
  std::int32_t total_scenes = 0;
  std::vector<SceneInfo> scenes;  ///< scenes of the daemon, in order of name
};

}  // namespace camway
