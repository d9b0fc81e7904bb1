// SPDX-License-Identifier: MIT
#include "daemon/process/settings/scene_argument.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "daemon/base/named_enum.h"
#include "daemon/messages/scene_names.h"
#include "daemon/process/settings/bounds_text.h"
#include "daemon/scene/import/record/import_words.h"
#include "daemon/scene/voxels/voxel_grid.h"

namespace camway::process {
namespace {

constexpr std::array<std::string_view, 7> kOptionNames{"scale",     "up",    "unknown", "voxel_m",
                                                       "occupancy", "watch", "bounds"};

std::optional<double> positive_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  if (!whole || !std::isfinite(value) || !(value > 0.0)) return std::nullopt;
  return value;
}

/// Applies one `key=value`. Returns an error or an empty text.
std::string apply_option(std::string_view key, std::string_view value, SceneArgument& scene) {
  if (key == "up") {
    const auto up = base::value_of<scene::UpAxis>(value);
    if (!up) return "up=" + std::string(value) + ": must be as-in-file, z-to-y or y-to-z";
    scene.options.import.up = *up;
    return {};
  }
  if (key == "watch") {
    if (value != "yes" && value != "no") {
      return "watch=" + std::string(value) + ": must be yes or no";
    }
    scene.watch = value == "yes";
    return {};
  }
  if (key == "unknown") {
    const auto unknown = base::value_of<scene::UnknownSpace>(value);
    if (!unknown) return "unknown=" + std::string(value) + ": must be free or occupied";
    scene.options.import.unknown = *unknown;
    return {};
  }
  if (key == "bounds") {
    const base::Result<geometry::Bounds> parsed = parse_bounds(value);
    if (parsed) scene.options.bounds = *parsed;
    return parsed.error;
  }
  const std::optional<double> number = positive_number(value);
  if (!number) {
    return std::string(key) + "=" + std::string(value) + ": must be a number above 0";
  }
  if (key == "scale") {
    scene.options.import.scale = *number;
    return {};
  }
  if (key == "voxel_m") {
    scene.options.import.voxel_m = *number;
  } else {
    scene.options.occupancy_resolution_m = *number;
  }
  if (scene::VoxelGrid::valid_resolution(*number)) return {};
  return std::string(key) + "=" + std::string(value) + ": " + messages::kResolutionRule;
}

/// Takes options off the end of `rest` until the text after the last comma is no option.
std::string take_options(std::string_view& rest, SceneArgument& scene) {
  while (true) {
    const std::size_t comma = rest.rfind(',');
    if (comma == std::string_view::npos) return {};
    const std::string_view last = rest.substr(comma + 1);
    const std::size_t equals = last.find('=');
    if (equals == std::string_view::npos) return {};
    const std::string_view key = last.substr(0, equals);
    if (std::find(kOptionNames.begin(), kOptionNames.end(), key) == kOptionNames.end()) {
      return "'" + std::string(key) +
             "' is no option of a scene (scale, up, unknown, voxel_m, occupancy, watch, bounds "
             "are)";
    }
    if (std::string error = apply_option(key, last.substr(equals + 1), scene); !error.empty()) {
      return error;
    }
    rest = rest.substr(0, comma);
  }
}

}  // namespace

base::Result<SceneArgument> parse_scene_argument(std::string_view text) {
  const auto fail = [&](const std::string& reason) {
    return base::Failure{"scene '" + std::string(text) + "': " + reason};
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return fail("must be NAME=FILE");
  SceneArgument scene;
  scene.name = text.substr(0, equals);
  if (!messages::is_scene_name(scene.name)) {
    return fail(std::string("the name ") + messages::kSceneNameRule);
  }
  std::string_view rest = text.substr(equals + 1);
  if (std::string error = take_options(rest, scene); !error.empty()) return fail(error);
  if (rest.empty()) return fail("the file is missing");
  scene.file = std::filesystem::path(rest);
  return scene;
}

}  // namespace camway::process
