// SPDX-License-Identifier: MIT
#include "tests/bench/columns.h"

#include <fmt/format.h>

#include <cmath>

namespace camway::bench {

std::string plain(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string as_duration(const nlohmann::json& seconds) { return duration_text(seconds); }

std::string as_ratio(const nlohmann::json& ratio) { return ratio_text(ratio); }

std::string as_number(const nlohmann::json& value) {
  const double number = value;
  return std::isfinite(number) ? fmt::format("{:.3g}", number) : "-";
}

std::string as_tenths(const nlohmann::json& value) {
  const double number = value;
  return std::isfinite(number) ? fmt::format("{:.1f}", number) : "-";
}

std::string as_share(const nlohmann::json& value) {
  return fmt::format("{:.0f} %", 100.0 * value.get<double>());
}

std::string as_numbers(const nlohmann::json& pair) {
  return as_number(pair[0]) + " / " + as_number(pair[1]);
}

std::string as_durations(const nlohmann::json& pair) {
  return as_duration(pair[0]) + " / " + as_duration(pair[1]);
}

}  // namespace camway::bench
