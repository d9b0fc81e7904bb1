// SPDX-License-Identifier: MIT
#include "tools/view/answer.h"

#include <algorithm>
#include <cstddef>

#include <nlohmann/json.hpp>

namespace camway::view {

std::string json_string(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string_view field_of(std::string_view error) {
  constexpr std::string_view kEnd = ": ";
  const auto belongs = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '[' || c == ']';
  };
  std::string_view field;
  for (std::size_t end = error.find(kEnd); end != std::string_view::npos; end = error.find(kEnd)) {
    const std::string_view first = error.substr(0, end);
    if (first.empty() || !std::ranges::all_of(first, belongs)) break;
    field = first;
    error.remove_prefix(end + kEnd.size());
  }
  return field;
}

std::string error_members(int code, std::string_view error) {
  std::string members = "\"error\": " + json_string(error);
  const std::string_view field = code == code::kInvalid ? field_of(error) : std::string_view();
  if (!field.empty()) members += ", \"field\": " + json_string(field);
  return members;
}

}  // namespace camway::view
