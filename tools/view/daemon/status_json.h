// SPDX-License-Identifier: MIT
#pragma once

#include <camway/daemon_status.h>

#include <nlohmann/json.hpp>

namespace camway::view {

/// Returns a heartbeat as JSON. Names from the daemon may hold any bytes: dump it with a handler
/// that replaces what is no UTF-8.
nlohmann::ordered_json status_json(const DaemonStatus& status);

}  // namespace camway::view
