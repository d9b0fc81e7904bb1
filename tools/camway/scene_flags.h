// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/scene/snapshot.h"

namespace camway::tools {

/// The flags about reading a scene that several subcommands share.
struct SceneFlags {
  std::string file;
  double scale = 1.0;
  scene::UpAxis up = scene::UpAxis::kAsInFile;
  scene::UnknownSpace unknown = scene::UnknownSpace::kFree;

  [[nodiscard]] scene::ImportOptions import_options() const;
};

/// Adds --scene, --scale, --up and --unknown. Returns the option of --scene, for the caller to say
/// whether it is required.
CLI::Option* add_scene_flags(CLI::App& command, SceneFlags& flags);

/// `as-in-file`, `z-to-y` or `y-to-z`, as on the command line.
std::string_view to_string(scene::UpAxis up);

/// A scene with what loading it took, or the reason why it could not be loaded.
struct LoadedScene {
  scene::SnapshotResult result;
  double load_ms = 0.0;
};

/// Loads each file once.
class SceneCache {
 public:
  explicit SceneCache(scene::SnapshotOptions options) : options_(options) {}

  /// The reference lives as long as the cache.
  const LoadedScene& load(const std::string& file);

 private:
  scene::SnapshotOptions options_;
  std::map<std::string, LoadedScene> scenes_;
};

/// Loads one scene and measures the time.
LoadedScene load_timed(const std::string& name, const std::string& file,
                       const scene::SnapshotOptions& options);

}  // namespace camway::tools
