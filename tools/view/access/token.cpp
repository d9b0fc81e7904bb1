// SPDX-License-Identifier: MIT
#include "tools/view/access/token.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>
#include <cstddef>

namespace camway::view {

std::string random_token() {
  constexpr std::size_t kTokenBytes = 16;
  std::array<unsigned char, kTokenBytes> bytes{};
  // So few bytes come at once, or not at all.
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) return {};
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool is_same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i])) ^
                  static_cast<unsigned>(static_cast<unsigned char>(b[i]));
    // Keeps the compiler from leaving the loop at the first difference.
    asm volatile("" : "+r"(difference));
  }
  return difference == 0;
}

}  // namespace camway::view
