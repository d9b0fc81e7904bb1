// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace camway::wire {

namespace detail {

/// Remainders of all bytes, reflected: the polynomial of ECMA-182.
inline constexpr std::array<std::uint64_t, 256> kCrc64Table = [] {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t byte = 0; byte < table.size(); ++byte) {
    std::uint64_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ ((remainder & 1) != 0 ? 0xC96C5795D7870F42 : 0);
    }
    table[byte] = remainder;
  }
  return table;
}();

}  // namespace detail

/// CRC-64/XZ, as in the .xz file format: guards against what networks do to bytes, not against
/// people. `before` is the checksum of the bytes before these, so that long data can come in parts.
inline std::int64_t crc64(const std::uint8_t* bytes, std::size_t size, std::int64_t before = 0) {
  std::uint64_t crc = ~static_cast<std::uint64_t>(before);
  for (std::size_t i = 0; i < size; ++i) {
    crc = (crc >> 8) ^ detail::kCrc64Table[(crc ^ bytes[i]) & 0xFF];
  }
  return static_cast<std::int64_t>(~crc);
}

}  // namespace camway::wire
