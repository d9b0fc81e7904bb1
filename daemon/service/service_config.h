// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/messages/deadline_limits.h"
#include "daemon/service/core/core_config.h"
#include "daemon/service/plans/plan_config.h"
#include "daemon/service/scenes/scene_config.h"
#include "daemon/service/watches/watch_limits.h"

namespace camway::service {

/// Configuration of the service: of its core and of each of its services.
struct ServiceConfig : CoreConfig, PlanConfig, SceneConfig {
  messages::DeadlineLimits occupancy_deadline;  ///< deadlines of batches of occupancy queries
  WatchLimits watches;                          ///< `watch.paths` and others
};

}  // namespace camway::service
