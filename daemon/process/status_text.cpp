// SPDX-License-Identifier: MIT
#include "daemon/process/status_text.h"

namespace camway::process {

std::string beginning_of(std::string_view text, std::size_t most_bytes) {
  if (text.size() <= most_bytes) return std::string(text);
  std::size_t size = most_bytes;
  const auto is_within_character = [&] {
    return (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U;
  };
  while (size > 0 && is_within_character()) --size;
  return std::string(text.substr(0, size));
}

}  // namespace camway::process
