// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/camway/replay/scenes/replay_scenes.h"

namespace camway::tools {

/// The scenes that the answers of plain logs name.
struct PlainScenes {
  std::map<std::string, std::shared_ptr<const scene::Snapshot>> found;  ///< by digest
  /// The requests whose scene was not found, by the reason.
  std::map<std::string, std::vector<const RecordedRequest*>> missing;
};

/// Finds the scenes. `session` must outlive the result.
PlainScenes plain_scenes_of(const Session& session, ReplayScenes& sources);

/// Writes scenes into a folder in the form of a recording, each once by its digest, with events of
/// the time `utime`. Returns an error, empty on success.
std::string write_scenes(
    const std::filesystem::path& folder, const std::string& prefix, std::int64_t utime,
    const std::map<std::string, std::shared_ptr<const scene::Snapshot>>& scenes);

}  // namespace camway::tools
