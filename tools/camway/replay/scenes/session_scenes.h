// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/camway/replay/scenes/replay_scenes.h"

namespace camway::tools {

/// Returns the folders of the contents of objects that belong to these logs.
std::vector<std::filesystem::path> blob_folders_of(const std::vector<std::filesystem::path>& logs);

/// The scenes of recordings: rebuilds each revision that an answer names from the changes that were
/// recorded.
class SessionScenes final : public ReplayScenes {
 public:
  /// `session` must outlive this.
  SessionScenes(const Session& session, std::vector<std::filesystem::path> blob_folders);
  ~SessionScenes() override;

  [[nodiscard]] FoundScene snapshot_of(const RecordedRequest& request) override;
  [[nodiscard]] bool knows(const std::string& name) const override { return names_.contains(name); }

 private:
  class Timeline;
  using Key = std::pair<std::string, std::string>;  ///< recording, and scene

  std::vector<std::filesystem::path> blob_folders_;
  std::set<std::string> names_;
  std::mutex mutex_;  ///< guards `timelines_`
  std::map<Key, std::unique_ptr<Timeline>> timelines_;
};

/// Scenes of a plain log that were packed with it (`camway pack`), by their digests.
class DigestScenes final : public ReplayScenes {
 public:
  /// `session` must outlive this.
  DigestScenes(const Session& session, std::vector<std::filesystem::path> blob_folders);

  [[nodiscard]] FoundScene snapshot_of(const RecordedRequest& request) override;
  [[nodiscard]] bool knows(const std::string& name) const override { return names_.contains(name); }

 private:
  std::vector<std::filesystem::path> blob_folders_;
  std::set<std::string> names_;
  std::map<std::string, const record::SceneUpdate*> updates_;  ///< by digest
  std::mutex mutex_;                                           ///< guards `found_`
  std::map<std::string, FoundScene> found_;                    ///< by digest
};

}  // namespace camway::tools
