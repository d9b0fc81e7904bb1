// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace camway::testing {

/// Does to `bytes` what the daemon does to a message on any of its channels, and what replay and
/// clients do to its answers: check, decode, join pages, convert, judge. Ends the process (abort)
/// where a promise is broken: what the check lets pass decodes, and encodes to the same bytes
/// again. What it refuses is refused with a reason. Returns for how many of these types the bytes
/// are right.
int exercise_message(std::span<const std::uint8_t> bytes);

}  // namespace camway::testing
