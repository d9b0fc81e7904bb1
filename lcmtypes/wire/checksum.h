// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace camway::wire {

namespace detail {

/// The polynomial of ECMA-182, with reflected bits.
inline constexpr std::uint64_t kCrc64Polynomial = 0xC96C5795D7870F42;

/// The remainder of each byte.
inline constexpr std::array<std::uint64_t, 256> kCrc64Table = [] {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t byte = 0; byte < table.size(); ++byte) {
    std::uint64_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ ((remainder & 1) != 0 ? kCrc64Polynomial : 0);
    }
    table[byte] = remainder;
  }
  return table;
}();

}  // namespace detail

/// Returns the CRC-64/XZ of some bytes, as the .xz file format has it. It detects transmission
/// errors, not deliberate changes. `before` is the checksum of the preceding bytes, so that long
/// data can be processed in parts.
inline std::int64_t crc64(const std::uint8_t* bytes, std::size_t size, std::int64_t before = 0) {
  std::uint64_t crc = ~static_cast<std::uint64_t>(before);
  for (std::size_t i = 0; i < size; ++i) {
    crc = (crc >> 8) ^ detail::kCrc64Table[(crc ^ bytes[i]) & 0xFF];
  }
  return static_cast<std::int64_t>(~crc);
}

/// Combines the checksums of two consecutive byte sequences, the second of `size` bytes, without
/// the bytes. A CRC is linear over GF(2), so appending `size` zero bytes multiplies it by a matrix,
/// which repeated squaring finds. [Source: zlib's crc32_combine, here for 64 bits]
class Crc64Joint {
 public:
  explicit Crc64Joint(std::size_t size) {
    Matrix step{};  // appends one zero bit
    step[0] = detail::kCrc64Polynomial;
    for (std::size_t bit = 1; bit < step.size(); ++bit) step[bit] = std::uint64_t{1} << (bit - 1);
    for (std::size_t bit = 0; bit < by_.size(); ++bit) by_[bit] = std::uint64_t{1} << bit;
    for (std::size_t bits = 8 * size; bits != 0; bits >>= 1) {
      if ((bits & 1) != 0) by_ = product(step, by_);
      step = product(step, step);
    }
  }

  /// Returns the checksum of both sequences from that of the first and that of the second.
  [[nodiscard]] std::int64_t operator()(std::int64_t first, std::int64_t second) const {
    return static_cast<std::int64_t>(times(by_, static_cast<std::uint64_t>(first))) ^ second;
  }

 private:
  /// A matrix over GF(2); element i is the image of bit i.
  using Matrix = std::array<std::uint64_t, 64>;

  static std::uint64_t times(const Matrix& matrix, std::uint64_t vector) {
    std::uint64_t sum = 0;
    for (std::size_t bit = 0; vector != 0; ++bit, vector >>= 1) {
      if ((vector & 1) != 0) sum ^= matrix[bit];
    }
    return sum;
  }
  static Matrix product(const Matrix& left, const Matrix& right) {
    Matrix result{};
    for (std::size_t bit = 0; bit < result.size(); ++bit) result[bit] = times(left, right[bit]);
    return result;
  }

  Matrix by_{};
};

}  // namespace camway::wire
