// SPDX-License-Identifier: MIT
#include "daemon/base/base64.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace camway::base {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
/// Three bytes have four digits of 6 bits.
constexpr std::size_t kGroupBytes = 3;
constexpr std::size_t kGroupDigits = 4;
constexpr std::uint8_t kNoDigit = 64;

constexpr std::array<std::uint8_t, 256> values_of_digits() {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNoDigit);
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
  }
  return values;
}

}  // namespace

std::string encode_base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + kGroupBytes - 1) / kGroupBytes * kGroupDigits);
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), kGroupBytes))) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < kGroupBytes; ++k) {
      bits = (bits << 8U) | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U);
    }
    const std::size_t digits = std::min(bytes.size(), kGroupBytes) + 1;
    for (std::size_t k = 0; k < kGroupDigits; ++k) {
      text += k < digits ? kDigits[(bits >> (18U - 6U * k)) & 0x3FU] : '=';
    }
  }
  return text;
}

std::optional<std::string> decode_base64(std::string_view text) {
  static constexpr std::array<std::uint8_t, 256> kValues = values_of_digits();
  if (text.size() % kGroupDigits != 0) return std::nullopt;
  const std::size_t padding = text.ends_with("==") ? 2 : (text.ends_with('=') ? 1 : 0);
  std::string bytes;
  bytes.reserve(text.size() / kGroupDigits * kGroupBytes);
  for (std::size_t i = 0; i < text.size(); i += kGroupDigits) {
    std::uint32_t bits = 0;
    for (std::size_t k = i; k < i + kGroupDigits; ++k) {
      const bool is_padding = k + padding >= text.size();
      const std::uint8_t value = kValues[static_cast<unsigned char>(text[k])];
      if (!is_padding && value == kNoDigit) return std::nullopt;
      bits = (bits << 6U) | (is_padding ? 0U : value);
    }
    for (const unsigned shift : {16U, 8U, 0U}) bytes += static_cast<char>((bits >> shift) & 0xFFU);
  }
  bytes.resize(bytes.size() - padding);
  return bytes;
}

}  // namespace camway::base
