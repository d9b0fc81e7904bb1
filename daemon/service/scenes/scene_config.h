// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/messages/deadline_limits.h"
#include "daemon/service/queue/fair_queue.h"
#include "daemon/service/scenes/map_exports.h"
#include "daemon/service/scenes/scene_rules.h"
#include "daemon/service/scenes/uploads.h"

namespace camway::service {

/// Configuration of scene requests.
struct SceneConfig {
  /// Deadlines of changes of scenes: generous, since a large scene takes its time.
  messages::DeadlineLimits change_deadline{.default_s = 600.0, .max_s = 3600.0};
  SceneRules scene_rules;
  Uploads::Limits uploads;     ///< `scenes.uploads` and others
  MapExports::Limits exports;  ///< `scenes.exports` and others
  /// Changes of different scenes that are made at the same time; `scenes.workers`
  /// [Limit: 1 <= value <= kMaxWorkers]
  int scene_workers = 4;
  FairQueue::Limits changes;  ///< waiting changes; `scenes.waiting_changes` and others
};

}  // namespace camway::service
