// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/scene/snapshot.h"

namespace camway::service {

/// A scene as the command lines of `camwayd` and `camway replay` name it.
struct SceneArgument {
  std::string name;
  std::filesystem::path file;
  scene::SnapshotOptions options;
};

/// A scene argument, or what is wrong with the text.
struct ParsedSceneArgument {
  std::optional<SceneArgument> scene;
  std::string error;
};

/// Whether `text` may name a scene: of [A-Za-z0-9_.-], at most `wire::kMaxSceneNameBytes` long.
bool is_scene_name(std::string_view text);

/// One line for `--help`.
inline constexpr char kSceneArgumentForm[] =
    "NAME=FILE[,scale=FACTOR][,up=z-to-y|y-to-z][,occupancy=RESOLUTION_M]";

/// Reads `text` of the form above. Options are taken off the end, so a FILE may hold commas unless
/// what follows one looks like an option. NAME is of [A-Za-z0-9_.-], at most
/// `wire::kMaxSceneNameBytes` long.
ParsedSceneArgument parse_scene_argument(std::string_view text);

}  // namespace camway::service
