// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace camway::process {

/// Returns the beginning of UTF-8 `text`, cut between characters, for a member of the status that
/// holds no more.
std::string beginning_of(std::string_view text, std::size_t most_bytes);

}  // namespace camway::process
