// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "tools/camway/replay/scenes/replay_scenes.h"

namespace camway::tools {

/// Reads the scene files below folders until each of these digests is found. Files that cannot be
/// read are passed over; only plain imports are tried, without a scale or a turn of axes.
std::map<std::string, std::shared_ptr<const scene::Snapshot>> find_by_digest(
    const std::set<std::string>& digests, const std::vector<std::filesystem::path>& folders);

/// The digests of the scenes that the answers of a session name.
std::set<std::string> digests_of(const Session& session);

/// Scenes that the digests of the answers name, whatever their names.
class ScenesByDigest final : public ReplayScenes {
 public:
  using Found = std::map<std::string, std::shared_ptr<const scene::Snapshot>>;

  /// Knows the scenes of `session` for which an answer names a digest in `found`. `why_not`:
  /// the reason for other digests.
  ScenesByDigest(const Session& session, Found found, std::string why_not);

  [[nodiscard]] FoundScene snapshot_of(const RecordedRequest& request) override;
  [[nodiscard]] bool knows(const std::string& name) const override { return names_.contains(name); }

 private:
  const Found found_;
  const std::string why_not_;
  std::set<std::string> names_;
};

}  // namespace camway::tools
