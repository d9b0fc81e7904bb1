// SPDX-License-Identifier: MIT
#include "tools/json/json_names.h"

#include <array>
#include <string>
#include <utility>

namespace camway::tools {
namespace {

/// Members with another name in files.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kNames{{
    {"camera.fov_x", "camera.fov_x_deg"},
    {"camera.fov_y", "camera.fov_y_deg"},
    {"options.default_speed", "options.default_speed_m_per_s"},
    {"options.orientation.cone", "options.orientation.cone_deg"},
    {"options.orientation.max_turn", "options.orientation.max_turn_deg"},
    {"options.limits.turn_rate", "options.limits.turn_rate_deg"},
}};

std::string spelled(std::string_view path) {
  for (const auto& [name, file_name] : kNames) {
    if (path == name) return std::string(file_name);
  }
  return std::string(path);
}

}  // namespace

planning::FieldSpelling json_spelling() { return spelled; }

}  // namespace camway::tools
