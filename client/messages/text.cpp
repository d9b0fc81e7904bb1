// SPDX-License-Identifier: MIT
#include "client/messages/text.h"

#include <chrono>

namespace camway {

std::int64_t microseconds_since_1970() {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(since).count();
}

std::optional<std::string> fault_in_text(const std::string& field, const std::string& text,
                                         std::size_t max_bytes) {
  if (text.size() > max_bytes) {
    return field + ": " + std::to_string(text.size()) + " bytes are too long, at most " +
           std::to_string(max_bytes) + " are allowed";
  }
  if (text.find('\0') != std::string::npos) return field + ": holds a NUL";
  return std::nullopt;
}

}  // namespace camway
