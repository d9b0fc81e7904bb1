// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::process {

/// A scene as named by the command lines of `camwayd` and `camway replay` or by the configuration.
struct SceneArgument {
  std::string name;
  std::filesystem::path file;
  scene::SnapshotOptions options;
  bool watch = false;  ///< whether the daemon reads the file again when it changes
  std::string set_at;  ///< where its file was named, e.g. "--scene" or "camwayd.toml:7"
};

/// The form of a scene argument, for `--help`.
inline constexpr char kSceneArgumentForm[] =
    "NAME=FILE[,scale=FACTOR][,up=z-to-y|y-to-z][,unknown=occupied][,voxel_m=EDGE_M][,occupancy="
    "RESOLUTION_M]"
    "[,watch=yes|no][,bounds=X0..X1/Y0..Y1/Z0..Z1]";

/// Reads `text` of that form. Options are taken off the end, so a FILE may hold commas unless the
/// text after one looks like an option. NAME consists of at most `wire::kMaxSceneNameBytes`
/// characters of [A-Za-z0-9_.-].
base::Result<SceneArgument> parse_scene_argument(std::string_view text);

}  // namespace camway::process
