// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "daemon/scene/log/scene_log.h"

namespace camway::scene {

static_assert(std::endian::native == std::endian::little, "records hold numbers as in memory");

/// The numbers of a record: little endian, doubles and floats bit for bit. Truth values have
/// functions of their own, because most bytes are none.
template <class T>
concept RecordNumber =
    (std::is_arithmetic_v<T> && !std::same_as<T, bool>) || std::same_as<T, std::byte>;

/// Writes a record. A value type. Not thread-safe.
class ByteWriter {
 public:
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }

  template <RecordNumber T>
  void put(T value) {
    put_array(std::span<const T>(&value, 1));
  }
  void put_flag(bool value) { put<std::uint8_t>(value ? 1 : 0); }
  /// Writes the values without their number.
  template <RecordNumber T>
  void put_array(std::span<const T> values) {
    const std::span<const std::byte> bytes = std::as_bytes(values);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  void put_count(std::size_t count) { put<std::uint64_t>(count); }
  /// Writes the size of the text and the text.
  void put_text(std::string_view text) {
    put_count(text.size());
    put_array(std::span<const char>(text));
  }

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  Bytes take() && { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Reads a record that anyone may have written. Remembers the first failure: all later reads fail,
/// too, so a caller may read several values before it asks. A failed read returns 0 or nothing.
/// No memory is allocated for more bytes than there are. The bytes must outlive it. A value type.
/// Not thread-safe.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <RecordNumber T>
  T get() {
    T value{};
    get_array(std::span<T>(&value, 1));
    return value;
  }
  /// Fails for a byte other than 0 and 1.
  bool get_flag() {
    const auto value = get<std::uint8_t>();
    if (value > 1) fail();
    return value == 1;
  }
  /// Reads as many values as `values` has; leaves them as they are if it fails.
  template <RecordNumber T>
  void get_array(std::span<T> values) {
    if (values.size_bytes() > rest_.size()) fail();
    if (has_failed_ || values.empty()) return;
    std::memcpy(values.data(), rest_.data(), values.size_bytes());
    rest_ = rest_.subspan(values.size_bytes());
  }
  /// Reads the number of things that follow. Fails if they would take more than the remaining bytes
  /// with `least_bytes` each. [Limit: 1 <= least_bytes]
  std::size_t get_count(std::size_t least_bytes) {
    const auto count = get<std::uint64_t>();
    if (count > rest_.size() / least_bytes) fail();
    return has_failed_ ? 0 : static_cast<std::size_t>(count);
  }
  /// Fails if the text has more than `most_bytes`.
  std::string get_text(std::size_t most_bytes) {
    const std::size_t size = get_count(1);
    if (size > most_bytes) fail();
    std::string text(has_failed_ ? 0 : size, ' ');
    get_array(std::span<char>(text));
    return text;
  }

  /// Number of bytes that were not read; 0 after a failure.
  [[nodiscard]] std::size_t remaining() const { return rest_.size(); }
  /// Whether all bytes were read, and no read failed.
  [[nodiscard]] bool is_at_end() const { return !has_failed_ && rest_.empty(); }
  [[nodiscard]] bool has_failed() const { return has_failed_; }
  /// Makes this and all later reads fail, where a value that was read cannot be.
  void fail() {
    has_failed_ = true;
    rest_ = {};
  }

 private:
  std::span<const std::byte> rest_;
  bool has_failed_ = false;
};

}  // namespace camway::scene
