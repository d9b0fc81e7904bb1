// SPDX-License-Identifier: MIT
#include "tools/json/json_writer.h"

#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

namespace camway::tools {

void JsonWriter::begin(std::string_view name) {
  const int indent = line_ >= 0 ? line_ : indent_;
  if (!is_first_) out_ += indent >= 0 ? "," : ", ";
  if (indent >= 0) new_line(indent);
  is_first_ = false;
  line_ = -1;
  out_.append("\"").append(name).append("\": ");
  path_.push_back(name);
}

// Writes the shortest decimal that reads back as the same double, always with a point or an
// exponent: otherwise readers take -0 for the integer 0 and lose the sign.
void JsonWriter::value(double number) {
  if (!std::isfinite(number)) {
    if (!error_.empty()) return;
    for (const std::string_view name : path_) {
      if (!error_.empty() && name != "[]") error_ += '.';
      error_ += name;
    }
    error_ += ": is not finite";
    return;
  }
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
  const std::string_view text(digits, static_cast<std::size_t>(end - digits));
  out_ += text;
  if (text.find_first_of(".e") == std::string_view::npos) out_ += ".0";
}

void JsonWriter::value(std::string_view text) {
  out_ += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void JsonWriter::value(const geometry::Bounds& bounds) {
  for (std::size_t side = 0; side < geometry::Bounds::kSides; ++side) {
    out_ += side == 0 ? "{\"min\": [" : side == 3 ? "], \"max\": [" : ", ";
    const double limit_m = bounds.limit_m(side);
    std::isinf(limit_m) ? void(out_ += "null") : value(limit_m);
  }
  out_ += "]}";
}

}  // namespace camway::tools
