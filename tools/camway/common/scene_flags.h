// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include <CLI/CLI.hpp>

#include "daemon/scene/cache/scene_cache.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tools/json/json_request.h"

namespace camway::tools {

/// The flags for reading a scene, which several subcommands share.
struct SceneFlags {
  std::string file;
  SceneReading reading;
  bool no_cache = false;

  /// Returns the options of the import: from the flags, else from the request, else the defaults.
  [[nodiscard]] scene::ImportOptions import_options(const SceneReading& of_request = {}) const;

  /// Returns the file of --scene, else the file that the request names, relative to the request's
  /// folder; empty if there is neither.
  [[nodiscard]] std::string file_for(const std::string& request_file,
                                     const planning::PlanRequest& request) const;
};

/// Adds --scene, --scale, --up, --unknown, --voxel-m and --no-cache. Returns the option --scene,
/// which the caller may make a required one.
CLI::Option* add_scene_flags(CLI::App& command, SceneFlags& flags);

/// Adds these flags to a command that reads a request. A flag that is not given takes its value
/// from the request.
void add_request_scene_flags(CLI::App& command, SceneFlags& flags);

/// Prints a warning if the request has `scale`, `up`, `unknown` or `voxel_m`. Call it in a command
/// that uses a scene which the daemon has loaded: these options then have no effect.
void warn_of_reading(const std::string& request_file, const RequestFile& request);

/// Returns the name of an axis conversion on the command line: as-in-file, z-to-y or y-to-z.
std::string_view to_string(scene::UpAxis up);

/// A scene, or the reason why it could not be loaded, and the time of loading.
struct LoadedScene {
  scene::SnapshotResult result;
  double load_ms = 0.0;
};

/// Returns this user's cache of prepared scenes; nothing with --no-cache or without a folder.
/// Prints a warning if the folder cannot be used. Call it once in a command.
std::optional<scene::SceneCache> user_cache(const SceneFlags& flags);

/// Loads each file once for each set of import options. Not thread-safe.
class LoadedScenes {
 public:
  explicit LoadedScenes(const SceneFlags& flags) : cache_(user_cache(flags)) {}

  /// Returns the scene. The reference is valid as long as this object.
  const LoadedScene& load(const std::string& file, const scene::ImportOptions& import);

 private:
  using Key =
      std::tuple<std::string, double, scene::UpAxis, scene::UnknownSpace, std::optional<double>>;
  std::optional<scene::SceneCache> cache_;
  std::map<Key, LoadedScene> scenes_;
};

/// Loads one scene, from the cache if there is one, and measures the time.
LoadedScene load_timed(const std::string& name, const std::string& file,
                       const scene::SnapshotOptions& options,
                       const std::optional<scene::SceneCache>& cache = std::nullopt);

}  // namespace camway::tools
