// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "daemon/process/settings/daemon_options.h"
#include "daemon/service/log/log.h"

namespace camway::process {

/// Plans for the fronts of the fleet that the options name, until SIGTERM or SIGINT, and reports to
/// the service manager. Returns the exit code of the process. Requires that no other thread has
/// begun.
int run_planner(const DaemonOptions& options, const std::shared_ptr<service::Log>& log);

}  // namespace camway::process
