// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/scene/snapshot/snapshot.h"

namespace camway::service {

/// A scene as the command lines of `camwayd` and `camway replay` and the daemon's configuration
/// name it.
struct SceneArgument {
  std::string name;
  std::filesystem::path file;
  scene::SnapshotOptions options;
  bool watch = false;   ///< whether the daemon reads the file again when it changes
  std::string said_at;  ///< where its file was named, e.g. "--scene" or "camwayd.toml:7"
};

/// "as-in-file", "z-to-y" or "y-to-z"; nothing for another word.
std::optional<scene::UpAxis> up_axis_named(std::string_view word);

/// "free" or "occupied"; nothing for another word.
std::optional<scene::UnknownSpace> unknown_space_named(std::string_view word);

/// A scene argument, or what is wrong with the text.
struct ParsedSceneArgument {
  std::optional<SceneArgument> scene;
  std::string error;
};

/// One line for `--help`.
inline constexpr char kSceneArgumentForm[] =
    "NAME=FILE[,scale=FACTOR][,up=z-to-y|y-to-z][,unknown=occupied][,occupancy=RESOLUTION_M]"
    "[,watch=yes|no][,bounds=X0..X1/Y0..Y1/Z0..Z1]";

/// Reads `text` of the form above. Options are taken off the end, so a FILE may hold commas unless
/// what follows one looks like an option. NAME is of [A-Za-z0-9_.-], at most
/// `wire::kMaxSceneNameBytes` long.
ParsedSceneArgument parse_scene_argument(std::string_view text);

}  // namespace camway::service
