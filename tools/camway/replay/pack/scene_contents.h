// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/camway/replay/session.h"

namespace camway::tools {

/// The contents of scenes that a session needs.
struct SceneContents {
  std::map<std::string, std::filesystem::path> files;  ///< sound ones, by their names in a pack
  /// A sentence for each one that is missing or damaged: its digest, and the objects, scenes and
  /// revisions that need it.
  std::vector<std::string> faults;
};

/// Finds the contents that the changes of scenes in `session` name, and those that these are
/// differences from, and reads all of them.
SceneContents scene_contents_of(const Session& session,
                                const std::vector<std::filesystem::path>& folders);

}  // namespace camway::tools
