// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace camway {

/// Returns the fault of a string that cannot be sent (too long, or a NUL inside), in a sentence
/// that begins with `field`; or nothing.
inline std::optional<std::string> fault_in_text(const std::string& field, const std::string& text,
                                                std::size_t max_bytes) {
  if (text.size() > max_bytes) {
    return field + ": " + std::to_string(text.size()) + " bytes are too long, at most " +
           std::to_string(max_bytes) + " are allowed";
  }
  if (text.find('\0') != std::string::npos) return field + ": holds a NUL";
  return std::nullopt;
}

}  // namespace camway
