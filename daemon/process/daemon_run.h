// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include "daemon/process/configured_scenes.h"
#include "daemon/process/fleet_member.h"
#include "daemon/process/reloader.h"
#include "daemon/process/settings/daemon_options.h"
#include "daemon/record/recorder.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"

namespace camway::process {

/// Serves `scenes` over LCM until SIGTERM or SIGINT, and reports to the service manager. At SIGHUP
/// reads its configuration again (`read_again`, on another thread), which changes the `configured`
/// scenes. Returns the exit code of the process. Does not return if planning was abandoned at the
/// drain limit, since its threads cannot be joined: ends the process with code 0. With a `fleet`,
/// which may be null, its planners plan. Messages are recorded by `recorder`, which may be null.
/// Requires that `block_reload_signal` and `block_stop_signals` were called before any other thread
/// began. With a `fleet`, calls `read_scenes` once it is clear that no other front has the prefix,
/// and ends with code 2 if it returns false; the scenes of others must not change before.
int serve(const DaemonOptions& options, Reloader::Read read_again, scene::SceneStore& scenes,
          ConfiguredScenes& configured, FleetMember* fleet, record::Recorder* recorder,
          const std::function<bool()>& read_scenes, const std::shared_ptr<service::Log>& log);

}  // namespace camway::process
