// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>

#include "daemon/scene/snapshot/change_ticket.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/scenes/scene_rules.h"

namespace camway::service {

/// References that a request is carried out with. All outlive the call.
struct OperationContext {
  const SceneRules& rules;
  scene::SceneStore& scenes;
  /// Held while a file below the roots is written: two requests may name the same file.
  std::mutex& writing;
  /// Cancelling it prevents any further change, and ends the reading of files and the building of
  /// mirrors.
  scene::ChangeTicket ticket;
};

}  // namespace camway::service
