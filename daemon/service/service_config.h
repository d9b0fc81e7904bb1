// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/service/config.h"
#include "daemon/service/plan_config.h"
#include "daemon/service/scene_config.h"
#include "daemon/service/watch_limits.h"
#include "daemon/service/wire_convert.h"

namespace camway::service {

/// How the service behaves: what its core and each of its services are given.
struct ServiceConfig : CoreConfig, PlanConfig, SceneConfig {
  DeadlineLimits occupancy_deadline;  ///< of batches of occupancy queries
  WatchLimits watches;                ///< `watch.paths` and others
};

}  // namespace camway::service
