// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <camway/scene_request_t.hpp>

#include "lcmtypes/wire/auth/message_keys.h"
#include "tools/camway/replay/scenes/replay_scenes.h"
#include "tools/camway/replay/scenes/root_scenes.h"

namespace camway::tools {

/// Returns whether a request asks for a change of a scene, not for a list, a map, or triangles.
bool changes_scene(const scene_request_t& request);

/// The result of `play_back_changes`.
struct PlayedBack {
  ScenesByDigest::Found scenes;     ///< those that answers of the session name, by their digests
  std::vector<std::string> faults;  ///< changes that could not be made again, a sentence each
};

/// Makes the changes of scenes again that clients asked for in plain logs, in the order of their
/// answers. `first`: the scenes as they were at the beginning of the logs. `roots`: the folders
/// of the files that clients named. The digests in the answers tell whether a scene became what it
/// was.
PlayedBack play_back_changes(const Session& session, const std::vector<std::filesystem::path>& logs,
                             const std::string& prefix, const wire::MessageKeys* keys,
                             const Scenes& first, const std::vector<std::filesystem::path>& roots);

}  // namespace camway::tools
