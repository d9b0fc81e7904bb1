// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <cstdint>
#include <optional>
#include <span>

namespace camway {

/// Returns the heartbeat in these bytes. Returns nothing if the bytes are not a valid heartbeat.
std::optional<DaemonStatus> read_status(std::span<const std::uint8_t> bytes);

}  // namespace camway
