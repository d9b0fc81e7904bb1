// SPDX-License-Identifier: MIT
#include "tools/cameras/files/mcap_records.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace camway::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "MCAP is little-endian");

/// The polynomial of CRC-32, its bits reversed.
constexpr std::uint32_t kCrcPolynomial = 0xEDB88320U;

/// The remainders of all bytes.
constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t remainder = i;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1U) ^ ((remainder & 1U) != 0U ? kCrcPolynomial : 0U);
    }
    table[i] = remainder;
  }
  return table;
}

}  // namespace

std::uint32_t crc32_of(std::string_view bytes) {
  static constexpr std::array<std::uint32_t, 256> kTable = crc_table();
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    crc = (crc >> 8U) ^ kTable[(crc ^ static_cast<unsigned char>(byte)) & 0xFFU];
  }
  return ~crc;
}

void McapBytes::append(const void* number, std::size_t size) {
  bytes_.append(static_cast<const char*>(number), size);
}

void McapBytes::text(std::string_view bytes) {
  u32(static_cast<std::uint32_t>(bytes.size()));
  raw(bytes);
}

void McapBytes::texts(const std::map<std::string, std::string>& entries) {
  McapBytes list;
  for (const auto& [key, value] : entries) {
    list.text(key);
    list.text(value);
  }
  text(list.bytes());
}

void McapBytes::record(McapOpcode opcode, const McapBytes& content) {
  bytes_ += static_cast<char>(opcode);
  u64(content.size());
  raw(content.bytes());
}

template <class Number>
Number McapCursor::number() {
  Number number{};
  const std::string_view bytes = raw(sizeof number);
  if (!failed_) std::memcpy(&number, bytes.data(), sizeof number);
  return number;
}

template std::uint8_t McapCursor::number();
template std::uint16_t McapCursor::number();
template std::uint32_t McapCursor::number();
template std::uint64_t McapCursor::number();

std::string_view McapCursor::raw(std::uint64_t size) {
  if (failed_ || size > rest_.size()) {
    failed_ = true;
    return {};
  }
  const std::string_view bytes = rest_.substr(0, static_cast<std::size_t>(size));
  rest_.remove_prefix(bytes.size());
  return bytes;
}

std::map<std::string, std::string> McapCursor::texts() {
  McapCursor list(text());
  std::map<std::string, std::string> entries;
  while (!list.rest().empty() && !list.failed()) {
    const std::string key(list.text());
    entries[key] = list.text();
  }
  failed_ = failed_ || list.failed();
  return entries;
}

}  // namespace camway::tools
