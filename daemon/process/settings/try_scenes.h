// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/process/settings/scene_argument.h"
#include "daemon/scene/snapshot/scene_store.h"

namespace camway::process {

/// Outcome of reading scenes, in their order.
struct TriedScenes {
  std::vector<std::string> found;   ///< a line for each valid scene
  std::vector<std::string> faults;  ///< for each invalid one, its place and the error
};

/// Reads scenes as a start of the daemon would, into a temporary store. Takes the time and the
/// memory of a start.
TriedScenes try_scenes(const std::vector<SceneArgument>& scenes,
                       const scene::SceneStoreLimits& limits);

}  // namespace camway::process
