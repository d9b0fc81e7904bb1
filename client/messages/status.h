// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <cstdint>
#include <optional>
#include <span>

namespace camway {

/// The heartbeat in these bytes; nothing if they hold none.
std::optional<DaemonStatus> read_status(std::span<const std::uint8_t> bytes);

}  // namespace camway
