// SPDX-License-Identifier: MIT
#pragma once

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
#include "daemon/scene/log/source_blobs.h"
#include "daemon/scene/snapshot/scene_journal.h"

namespace camway::scene {

/// Keeps the scenes of a store in a log, and finds them there again. Once a scene has some hundred
/// entries, a summary replaces them, so that a start reads little.
/// Thread-safe, as `SceneJournal` demands.
class DurableScenes : public SceneJournal {
 public:
  /// Refers to `log`, which must outlive it.
  explicit DurableScenes(SceneLog& log) : log_(log), sources_(log) {}

  /// Returns the scenes of the log with their histories, in order of name. Fails if anything is
  /// damaged, with the reason. Must be called once, before any change.
  base::Result<std::vector<SceneHistory>> load(const SceneHistory::Limits& limits);

  std::string keep_scene(const Snapshot& first, std::uint64_t before,
                         const ChangeNote& note) override;
  std::string keep_changes(const Snapshot& before, const Snapshot& next,
                           const SceneChanges& changes, const ChangeNote& note,
                           std::uint64_t oldest_revision) override;
  std::string keep_removal(const Snapshot& last) override;

 private:
  struct Kept {
    RecordedScene scene;
    std::size_t entries = 0;  ///< in the log, since the last summary
  };

  base::Result<SceneHistory> load_scene(const LoggedScene& logged,
                                        const SceneHistory::Limits& limits);
  base::Result<SceneHistory> history_of(const std::string& name, const RecordedScene& scene,
                                        const SceneHistory::Limits& limits);
  base::Result<RecordedChange> recorded(const SceneChange& change, const Snapshot& before);
  /// Replaces the entries of a scene by a summary, if there are many, and drops what nothing needs.
  void summarize(const std::string& name, Kept& kept, std::uint64_t oldest_revision);
  Kept& kept_of(const std::string& name);

  SceneLog& log_;
  SourceBlobs sources_;
  /// Held shared from the putting of blobs to the entry that names them, and alone while unused
  /// blobs are dropped.
  std::shared_mutex blobs_in_use_;
  std::mutex mutex_;  ///< guards the map; each scene in it is used by one thread at a time
  std::map<std::string, Kept, std::less<>> kept_;
};

}  // namespace camway::scene
