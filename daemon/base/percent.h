// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <system_error>

namespace camway::base {

/// Returns a text of a URI with its characters as they are: "a%20b" is "a b". A '%' that two
/// hexadecimal digits do not follow stays.
inline std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t at = 0; at < text.size(); ++at) {
    unsigned value = 0;
    const char* const begin = text.data() + at + 1;
    const bool is_code = text[at] == '%' && text.size() - at > 2;
    const auto read = is_code ? std::from_chars(begin, begin + 2, value, 16)
                              : std::from_chars_result{begin, std::errc::invalid_argument};
    if (read.ec != std::errc{} || read.ptr != begin + 2) {
      decoded += text[at];
      continue;
    }
    decoded += static_cast<char>(value);
    at += 2;
  }
  return decoded;
}

}  // namespace camway::base
