// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace camway::wire {

namespace detail {

/// Of ECMA-182, reflected.
inline constexpr std::uint64_t kCrc64Polynomial = 0xC96C5795D7870F42;

/// Remainders of all bytes.
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

/// CRC-64/XZ, as in the .xz file format: guards against what networks do to bytes, not against
/// people. `before` is the checksum of the bytes before these, so that long data can come in parts.
inline std::int64_t crc64(const std::uint8_t* bytes, std::size_t size, std::int64_t before = 0) {
  std::uint64_t crc = ~static_cast<std::uint64_t>(before);
  for (std::size_t i = 0; i < size; ++i) {
    crc = (crc >> 8) ^ detail::kCrc64Table[(crc ^ bytes[i]) & 0xFF];
  }
  return static_cast<std::int64_t>(~crc);
}

/// Joins checksums: that of some bytes and `size` more, of which there are but the checksums. A
/// checksum is linear in the bits before it (over the field of two elements), so what further bytes
/// do to it is a matrix, found by squaring; as zlib does for CRC-32.
class Crc64Joint {
 public:
  explicit Crc64Joint(std::size_t size) {
    Matrix step{};  // of one zero bit
    step[0] = detail::kCrc64Polynomial;
    for (std::size_t bit = 1; bit < step.size(); ++bit) step[bit] = std::uint64_t{1} << (bit - 1);
    for (std::size_t bit = 0; bit < by_.size(); ++bit) by_[bit] = std::uint64_t{1} << bit;
    for (std::size_t bits = 8 * size; bits != 0; bits >>= 1) {
      if ((bits & 1) != 0) by_ = product(step, by_);
      step = product(step, step);
    }
  }

  /// `second` is the checksum of the `size` bytes.
  [[nodiscard]] std::int64_t operator()(std::int64_t first, std::int64_t second) const {
    return static_cast<std::int64_t>(times(by_, static_cast<std::uint64_t>(first))) ^ second;
  }

 private:
  /// What becomes of each bit.
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
