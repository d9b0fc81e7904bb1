// SPDX-License-Identifier: MIT
#include "tools/view/answer.h"

#include <nlohmann/json.hpp>

namespace camway::view {

std::string json_string(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string error_json(std::string_view error) { return "{\"error\": " + json_string(error) + "}"; }

}  // namespace camway::view
