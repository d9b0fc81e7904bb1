// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace camway::base {

/// Returns the unsigned number whose bytes are `bytes`, the most significant one first; 0 for no
/// bytes. Requires at most 8 of them.
constexpr std::uint64_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8U | byte;
  return value;
}

}  // namespace camway::base
