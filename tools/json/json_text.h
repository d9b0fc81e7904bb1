// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace camway::tools {

/// Returns `json` as text, in one line if `indent` is negative. Names of files, objects and cameras
/// may be in any encoding: bytes that are not UTF-8 become U+FFFD, where `dump` alone throws.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Returns `text` with these bytes replaced.
inline std::string as_utf8(const std::string& text) {
  return nlohmann::json::parse(json_text(nlohmann::json(text))).get<std::string>();
}

}  // namespace camway::tools
