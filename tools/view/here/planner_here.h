// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/view/backend.h"

namespace camway::view {

struct HereOptions {
  int threads = 2;  ///< plans at a time, each on as many processors as it can use
  /// The name that answers give as their scene, as those of `camway plan` do.
  std::string scene_text = {};
  /// How the file of the scene was read, which answers say; nothing if it is unknown.
  std::optional<scene::ImportOptions> scene_reading = {};
};

/// Returns a backend that plans in this process, in the scene of `snapshot`, which changes as
/// clients say. Answers are those of `camway plan`, bit for bit, timing and the scene's name apart.
/// Paths are not watched; changes of scenes are told.
std::unique_ptr<Backend> plan_here(std::shared_ptr<const scene::Snapshot> snapshot,
                                   const HereOptions& options = {});

}  // namespace camway::view
