// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Bytes as text (RFC 4648, section 4), with padding.
namespace camway::base {

std::string encode_base64(std::string_view bytes);

/// Returns the bytes, or nothing if the text is no base64. Bits of the last digit that no byte
/// takes are not looked at.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace camway::base
