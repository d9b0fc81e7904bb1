// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/process/scene_argument.h"
#include "daemon/scene/snapshot/scene_store.h"

namespace camway::service {

/// What became of scenes, in their order.
struct TriedScenes {
  std::vector<std::string> found;   ///< a line for each that is good
  std::vector<std::string> faults;  ///< for each other one, where it was said and what is wrong
};

/// Reads scenes as a start of the daemon would, into a store of its own that is gone afterwards.
/// Takes the time and the memory that the start takes.
TriedScenes try_scenes(const std::vector<SceneArgument>& scenes,
                       const scene::SceneStoreLimits& limits);

}  // namespace camway::service
