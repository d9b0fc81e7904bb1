// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "daemon/base/result.h"
#include "lcmtypes/wire/auth/message_keys.h"
#include "tools/camway/replay/scenes/replay_scenes.h"
#include "tools/camway/session/session_files.h"

namespace camway::tools {

/// The files and folders in which a command looks for the scenes of a session.
struct SceneSourceFlags {
  std::vector<std::string> scenes;  ///< `--scene`
  std::vector<std::string> roots;   ///< `--root`
};

void add_scene_source_flags(CLI::App& command, SceneSourceFlags& flags);

/// Returns the scenes of a session: those that the flags name, those of its recording, and those
/// that follow from the messages of a plain log. Prints the changes that cannot be made again.
/// Fails if a flag is wrong, a file cannot be read, or nothing is known of a scene. `keys` may be
/// null. `session` must outlive the result.
base::Result<std::unique_ptr<ReplayScenes>> open_scene_sources(const SceneSourceFlags& flags,
                                                               const Session& session,
                                                               const SessionFiles& files,
                                                               const std::string& prefix,
                                                               const wire::MessageKeys* keys);

}  // namespace camway::tools
