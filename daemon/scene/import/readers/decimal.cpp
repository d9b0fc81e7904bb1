// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/decimal.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace camway::scene::mesh_readers {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The exponent behind the e, clamped to a magnitude that no mantissa in a file can compensate.
std::int64_t clamped_exponent(std::string_view text) {
  constexpr std::int64_t kEnough = std::int64_t{1} << 60;
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range || value > kEnough) value = kEnough;
  return negative ? -value : value;
}

/// Whether a decimal beyond the range of doubles is too large, not too small. The power of ten of
/// its first nonzero digit decides.
bool is_too_large(std::string_view digits) {
  const std::size_t e = digits.find_first_of("eE");
  const std::string_view mantissa = digits.substr(0, e);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return false;
  auto power = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  if (e != std::string_view::npos) power += clamped_exponent(digits.substr(e + 1));
  return power > 0;
}

/// `from_chars` accepts no plus.
std::string_view without_plus(std::string_view token) {
  const bool plus = token.size() > 1 && token[0] == '+' && token[1] != '-';
  return plus ? token.substr(1) : token;
}

}  // namespace

double parse_decimal(std::string_view token) {
  token = without_plus(token);
  double value = kNaN;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size() || error == std::errc::invalid_argument) return kNaN;
  if (error != std::errc::result_out_of_range) return value;
  const bool negative = token.starts_with('-');
  if (negative) token.remove_prefix(1);
  const double size = is_too_large(token) ? std::numeric_limits<double>::infinity() : 0.0;
  return negative ? -size : size;
}

std::optional<std::int64_t> parse_integer(std::string_view token) {
  token = without_plus(token);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc{} || end != token.data() + token.size()) return std::nullopt;
  return value;
}

}  // namespace camway::scene::mesh_readers
