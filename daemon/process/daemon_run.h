// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "daemon/process/configured_scenes.h"
#include "daemon/process/options.h"
#include "daemon/process/reloader.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"

namespace camway::service {

/// Serves `scenes` over LCM until SIGTERM or SIGINT, tells the service manager how it goes, and
/// reads its configuration again (`read_again`, on another thread) at SIGHUP, which changes the
/// scenes that are `configured`. Returns the exit code of the process; does not return at all if
/// planning had to be abandoned at the drain limit, for then its threads cannot be joined: the
/// process ends there, with code 0. Precondition: `block_reload_signal` and `block_stop_signals`
/// were called before any other thread began.
int serve(const DaemonOptions& options, Reloader::Read read_again, scene::SceneStore& scenes,
          ConfiguredScenes& configured, const std::shared_ptr<Log>& log);

}  // namespace camway::service
