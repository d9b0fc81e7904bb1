// SPDX-License-Identifier: MIT
#pragma once

#include <spdlog/logger.h>

#include <memory>

#include "daemon/scene/scene_store.h"
#include "daemon/service/daemon_options.h"

namespace camway::service {

/// Loads the scenes in order into `store` and logs what was read and assumed. Returns false, with
/// the file and the reason logged, at the first that cannot be loaded.
bool load_scenes(const DaemonOptions& options, scene::SceneStore& store, spdlog::logger& log);

/// Serves `scenes` over LCM until SIGTERM or SIGINT. Returns the exit code of the process; does not
/// return at all if planning had to be abandoned at the drain limit, for then its threads cannot be
/// joined: the process ends there, with code 0. Precondition: `block_stop_signals` was called
/// before any other thread began.
int serve(const DaemonOptions& options, scene::SceneStore& scenes,
          const std::shared_ptr<spdlog::logger>& log);

}  // namespace camway::service
