// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <variant>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/record/log_files.h"
#include "daemon/record/session_events.h"
#include "daemon/record/trouble_log.h"
#include "daemon/scene/snapshot/scene_change.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "daemon/service/log/log.h"

namespace camway::record {

class RecordWriter;

struct RecordOptions {
  std::filesystem::path folder;
  std::string prefix = "CAMWAY";  ///< of the daemon's channels
  RecordLimits limits;
  /// Most that waits for the disk. Messages beyond it are left out and counted.
  std::uint64_t waiting_bytes = std::uint64_t{64} << 20;
  std::size_t waiting_changes = 4096;  ///< changes of scenes that may wait
  /// Time between two writes, since many small ones would cost as much as the messages.
  std::chrono::milliseconds pause{100};
  TroubleLog::Times trouble;
};

/// Facts about the daemon that records, for people who look at a recording.
struct RecordFacts {
  std::string version;
  std::map<std::string, std::string> settings;  ///< without secrets
};

/// Numbers since the start.
struct RecordCounts {
  std::uint64_t recorded = 0;  ///< messages and changes of scenes in files
  std::uint64_t bytes = 0;     ///< of the recorded events
  std::uint64_t dropped = 0;   ///< left out: the disk is full, or too slow
  std::uint64_t files = 0;     ///< files that were begun
  std::string trouble;         ///< why events are being lost (`TroubleLog`); empty if none are
};

/// A change of a scene on its way to the disk. The snapshots have no meshes or trees of the whole
/// scene.
struct ChangedScene {
  enum class Kind : std::uint8_t { kPut, kChange, kRemove };
  Kind kind = Kind::kPut;
  std::shared_ptr<const scene::Snapshot> after;  ///< the last one of a scene that is removed
  std::uint64_t before = 0;                      ///< revision; kChange only
  scene::SceneChanges changes;                   ///< kChange only
  scene::ChangeNote note;
};

/// The newest snapshots of scenes by their names.
using SceneMap = std::map<std::string, std::shared_ptr<const scene::Snapshot>, std::less<>>;

/// Brings a change into the newest scenes. A change that another process has made may come after a
/// later one of this process, and then changes nothing.
void take(const ChangedScene& change, SceneMap& newest);

struct RecordedMessage {
  std::int64_t utime = 0;
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

/// Records the messages of a daemon and the changes of its scenes into files of a folder, which
/// `camway replay` plans again, and which the tools of LCM read. A thread of its own writes, so no
/// caller waits for the disk: where it is full or slow, messages are left out, and the recording
/// has an `Omission` for them. Thread-safe.
class Recorder {
 public:
  /// Fails if the folder cannot be used, with the reason. `log` gets warnings, within limits.
  static base::Result<std::unique_ptr<Recorder>> open(const RecordOptions& options,
                                                      RecordFacts facts,
                                                      std::shared_ptr<service::Log> log);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Records a message as it is on the network. Copies it and returns.
  void message(std::string_view channel, std::span<const std::uint8_t> bytes);

  /// Records a scene that is new, or that takes the place of the one of its name.
  void scene_put(const scene::Snapshot& scene, const scene::ChangeNote& note);
  /// Records changes that made `next` of the revision `before`.
  void scene_changed(std::uint64_t before, const scene::Snapshot& next,
                     const scene::SceneChanges& changes, const scene::ChangeNote& note);
  void scene_removed(const scene::Snapshot& last);

  /// Writes all that waits, and ends. Later messages are left out.
  void finish();

  [[nodiscard]] RecordCounts counts() const;

 private:
  using Item = std::variant<RecordedMessage, ChangedScene>;
  Recorder(const RecordOptions& options, std::unique_ptr<RecordWriter> writer);
  void add(ChangedScene change);
  /// Counts events that are left out. Requires that `mutex_` is held.
  void drop(std::uint64_t messages, std::uint64_t changes);
  /// Returns whether so much waits that the thread must not pause. Requires that `mutex_` is held.
  [[nodiscard]] bool is_crowded() const;
  void run();

  const RecordOptions options_;
  std::unique_ptr<RecordWriter> writer_;
  mutable std::mutex mutex_;  ///< guards all below but `thread_`
  std::condition_variable arrived_;
  std::deque<Item> waiting_;
  std::uint64_t waiting_bytes_ = 0;
  std::size_t waiting_changes_ = 0;
  Omission dropped_;  ///< since the last batch
  std::uint64_t all_dropped_ = 0;
  SceneMap scenes_;  ///< newest scenes
  bool is_finishing_ = false;
  std::thread thread_;
};

}  // namespace camway::record
