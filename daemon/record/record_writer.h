// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/record/log_files.h"
#include "daemon/record/recorder.h"
#include "daemon/record/session_events.h"
#include "daemon/record/trouble_log.h"
#include "daemon/record/update_log.h"
#include "daemon/scene/log/durable_scenes.h"

namespace camway::record {

/// Writes the events of a recording. After a failed write it tries again a while later, and records
/// the omission.
/// Not thread-safe, but for `counts`: for the thread that writes.
class RecordWriter {
 public:
  RecordWriter(const std::string& prefix, RecordFacts facts, std::string recording, LogFiles files,
               std::shared_ptr<service::Log> log, const TroubleLog::Times& trouble);

  void write(const RecordedMessage& message);
  void write(const ChangedScene& change);
  /// Records an omission after all events so far, and the scenes as they are after it.
  void skip(const Omission& omission, const SceneMap& scenes);
  /// Writes all events to the disk, as far as that is possible.
  void flush();
  /// Flushes, and records an omission that is still open.
  void finish();

  /// Returns the counts without events that never reached the writer (`skip`). Thread-safe.
  [[nodiscard]] RecordCounts counts() const;

 private:
  using Steady = std::chrono::steady_clock;

  /// Makes the files ready for another event: begins the next one, or tries again after a failure.
  /// Returns false if that is not possible now.
  bool is_ready();
  /// Adds the events at the beginning of a file and after an omission.
  bool begin_events();
  void keep(const ChangedScene& change);
  void add(const SessionEvent& event);
  void add(std::int64_t utime, std::string_view channel, std::span<const std::uint8_t> bytes);
  /// Writes the events that wait. Returns false if that is not possible.
  bool write_events();
  /// Counts events that are not recorded since `fail`; the first one is of this time.
  void lose(std::uint64_t messages, std::uint64_t changes, std::int64_t utime);
  void note_omission(const Omission& omission);
  /// Handles a failed write, after which nothing is written for a while.
  void fail(const scene::AppendResult& why);

  const std::string prefix_;
  const std::string channel_;
  const RecordFacts facts_;
  const std::string recording_;
  TroubleLog trouble_;
  LogFiles files_;
  UpdateLog updates_;
  scene::DurableScenes recorded_;
  SceneMap scenes_;     ///< as they are after the last event, written or lost
  std::string digest_;  ///< of the scene that is being recorded
  std::vector<std::uint8_t> events_;
  std::uint64_t messages_ = 0;  ///< in `events_`
  std::uint64_t changes_ = 0;   ///< in `events_`
  std::int64_t first_utime_ = 0;
  std::int64_t number_ = 0;
  bool has_begun_ = false;            ///< whether the present file has its first events
  std::optional<Omission> omission_;  ///< the omission since the last event
  Steady::time_point retry_at_{};
  std::string fault_;  ///< of the last write that failed
  std::atomic<std::uint64_t> recorded_count_ = 0;
  std::atomic<std::uint64_t> recorded_bytes_ = 0;
  std::atomic<std::uint64_t> lost_ = 0;
  std::atomic<std::uint64_t> file_count_ = 0;
};

}  // namespace camway::record
