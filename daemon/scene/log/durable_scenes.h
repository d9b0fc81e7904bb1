// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/log/change_record.h"
#include "daemon/scene/log/scene_log.h"
#include "daemon/scene/log/shared_log.h"
#include "daemon/scene/log/source_blobs.h"
#include "daemon/scene/snapshot/scene_journal.h"
#include "daemon/scene/snapshot/scene_store.h"

namespace camway::scene {

/// Keeps the scenes of a store in a log, and finds them there again. Once a scene has some hundred
/// entries, a summary replaces them, so that a start reads little.
///
/// Other processes may write the log too. `read` then has to see each update of it.
/// Thread-safe, as `SceneJournal` demands.
class DurableScenes : public SceneJournal {
 public:
  /// Refers to `log`, which must outlive it. `patience`: how long `await_other` and `catch_up`
  /// wait; 0 if no other process writes the log.
  explicit DurableScenes(SceneLog& log,
                         std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  ~DurableScenes() override;
  DurableScenes(const DurableScenes&) = delete;
  DurableScenes& operator=(const DurableScenes&) = delete;

  /// Leaves the occupancy mirrors out of all scenes that are read from now on, which saves time and
  /// memory where nobody asks for occupancy. Digests are the same. Requires that nothing is kept by
  /// this object.
  void leave_out_mirrors() { has_mirrors_ = false; }

  /// Returns the scenes of the log with their histories, in order of name. Fails if anything is
  /// damaged, with the reason. Must be called once, before any change.
  base::Result<std::vector<SceneHistory>> load(const SceneHistory::Limits& limits);

  /// Returns what an update of the log makes of its scene, whose newest snapshot in the store is
  /// `newest`, null if there is none. Returns nothing if the store has it already, as it has its
  /// own changes. Fails if the update is damaged, or if one before it is missing. For
  /// `SceneStore::follow`.
  base::Result<SceneStore::OthersWork> read(const LogUpdate& update, const Snapshot* newest,
                                            const SceneHistory::Limits& limits);

  Keeping keep_scene(const Snapshot& first, std::uint64_t before, const ChangeNote& note) override;
  Keeping keep_changes(const Snapshot& before, const Snapshot& next, const SceneChanges& changes,
                       const ChangeNote& note, std::uint64_t oldest_revision) override;
  Keeping keep_removal(const Snapshot& last, const std::string& request) override;
  bool await_other(const std::string& scene, std::uint64_t revision) override;
  bool catch_up() override { return log_.catch_up(patience_); }

 private:
  struct Kept {
    RecordedScene scene;
    std::size_t entries = 0;  ///< in the log, since the last summary
  };

  base::Result<SceneHistory> load_scene(const LoggedScene& logged,
                                        const SceneHistory::Limits& limits);
  base::Result<SceneHistory> history_of(const std::string& name, const RecordedScene& scene,
                                        const SceneHistory::Limits& limits);
  AppendResult record(const SceneChange& change, const Snapshot& before, RecordedChange& record);
  base::Result<SceneStore::OthersWork> read_scene(const LogUpdate& update, RecordedScene scene,
                                                  std::uint64_t known,
                                                  const SceneHistory::Limits& limits);
  base::Result<SceneStore::OthersWork> read_revision(const LogUpdate& update,
                                                     RecordedRevision revision,
                                                     const Snapshot& newest);
  /// Replaces the entries of a scene by a summary, if there are many, and drops what nothing needs.
  void summarize(const std::string& name, Kept& kept, std::uint64_t oldest_revision);
  Kept& kept_of(const std::string& name);
  void forget(const std::string& name);
  /// Notes the newest revision of a scene, 0 if it is removed, for `await_other`.
  void note_newest(const std::string& name, std::uint64_t revision);

  SceneLog& log_;
  const std::chrono::milliseconds patience_;
  bool has_mirrors_ = true;
  SourceBlobs sources_;
  /// Held shared from the putting of blobs to the entry that names them, and alone while unused
  /// blobs are dropped.
  std::shared_mutex blobs_in_use_;
  std::mutex mutex_;  ///< guards all below; each scene of `kept_` is used by one thread at a time
  std::map<std::string, Kept, std::less<>> kept_;
  std::condition_variable arrived_;
  std::map<std::string, std::uint64_t, std::less<>> newest_;  ///< revisions of `kept_`
};

}  // namespace camway::scene
