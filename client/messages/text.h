// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace camway {

/// Returns the present time for `utime` members: microseconds since 1970.
std::int64_t microseconds_since_1970();

/// Returns the fault of a string that cannot be sent (too long, or a NUL inside), in a sentence
/// that begins with `field`; or nothing.
std::optional<std::string> fault_in_text(const std::string& field, const std::string& text,
                                         std::size_t max_bytes);

}  // namespace camway
