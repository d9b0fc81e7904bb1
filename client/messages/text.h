// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace camway {

/// The time for `utime` members: microseconds since 1970.
std::int64_t microseconds_since_1970();

/// What is wrong with `text` as a string on the wire, in a sentence that begins with `field`:
/// too long, or a NUL inside. Nothing if all is well.
std::optional<std::string> fault_in_text(const std::string& field, const std::string& text,
                                         std::size_t max_bytes);

}  // namespace camway
