// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/messages/convert.h"
#include "daemon/service/core/config.h"
#include "daemon/service/plans/plan_config.h"
#include "daemon/service/scenes/scene_config.h"
#include "daemon/service/watches/watch_limits.h"

namespace camway::service {

/// How the service behaves: what its core and each of its services are given.
struct ServiceConfig : CoreConfig, PlanConfig, SceneConfig {
  DeadlineLimits occupancy_deadline;  ///< of batches of occupancy queries
  WatchLimits watches;                ///< `watch.paths` and others
};

}  // namespace camway::service
