// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>

#include "daemon/scene/snapshot/change_ticket.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/scenes/scene_rules.h"

namespace camway::service {

/// What a request is carried out on. All references outlive the call.
struct SceneContext {
  const SceneRules& rules;
  scene::SceneStore& scenes;
  std::mutex& writing;  ///< held by who writes a file below the roots: two might mean the same
  /// Called off, nothing is changed any more, and the reading of files and the making of mirrors
  /// ends.
  scene::Undertaking undertaking;
};

}  // namespace camway::service
