// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "camway/client.h"

namespace camway {

/// The heartbeat in these bytes; nothing if they hold none.
std::optional<DaemonStatus> read_status(std::span<const std::uint8_t> bytes);

}  // namespace camway
