// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

#include <camway/status_t.hpp>

#include "daemon/service/core/core.h"

namespace camway::service {

/// Returns the heartbeat. Lists scenes in the order of names, as many as keep the message within
/// `wire::kMaxMessageBytes` (about 200 with the longest names); `total_scenes` counts all.
/// `uptime`: the time since the daemon started.
///
/// Not thread-safe: for the loop thread.
status_t make_status(const Core& core, std::chrono::duration<double> uptime);

/// Drops the last scenes of a status that has grown beyond `wire::kMaxMessageBytes` since.
void fit_message(status_t& status);

}  // namespace camway::service
