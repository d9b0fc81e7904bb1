// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace camway::testing {

/// Processes `bytes` like the daemon with a message on each of its channels, and like replay and
/// clients with its answers: check, decode, join pages, convert, validate. Returns the number of
/// message types that the bytes are valid for. Aborts the process if a promise is broken: a message
/// that passes the check decodes, and encodes to the same bytes; a refusal has a reason.
int exercise_message(std::span<const std::uint8_t> bytes);

}  // namespace camway::testing
