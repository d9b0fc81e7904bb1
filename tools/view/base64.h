// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace camway::view {

/// Decodes base64 (RFC 4648) with padding. Returns nothing if it is none.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace camway::view
