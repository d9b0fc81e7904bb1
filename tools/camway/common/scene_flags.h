// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <tuple>

#include <CLI/CLI.hpp>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/json/json_io.h"

namespace camway::tools {

/// The flags about reading a scene that several subcommands share.
struct SceneFlags {
  std::string file;
  SceneReading reading;

  /// How to read the scene: as the flags say, else as the request does, else as usual.
  [[nodiscard]] scene::ImportOptions import_options(const SceneReading& of_request = {}) const;

  /// The file of --scene, or the request's own, which is relative to the folder of the request;
  /// empty if there is neither.
  [[nodiscard]] std::string file_for(const std::string& request_file,
                                     const planning::PlanRequest& request) const;
};

/// Adds --scene, --scale, --up and --unknown. Returns the option of --scene, for the caller to say
/// whether it is required.
CLI::Option* add_scene_flags(CLI::App& command, SceneFlags& flags);

/// The same for a command that reads a request: its scene, and how to read it, hold where a flag is
/// not given.
void add_request_scene_flags(CLI::App& command, SceneFlags& flags);

/// Warns of `scale`, `up` and `unknown` in a request for a scene that is not read for it: it is the
/// daemon's, or --scene says how to read it.
void warn_of_reading(const std::string& request_file, const RequestFile& request);

/// `as-in-file`, `z-to-y` or `y-to-z`, as on the command line.
std::string_view to_string(scene::UpAxis up);

/// A scene with what loading it took, or the reason why it could not be loaded.
struct LoadedScene {
  scene::SnapshotResult result;
  double load_ms = 0.0;
};

/// Loads each file once for each way of reading it.
class SceneCache {
 public:
  /// The reference lives as long as the cache.
  const LoadedScene& load(const std::string& file, const scene::ImportOptions& import);

 private:
  using Key = std::tuple<std::string, double, scene::UpAxis, scene::UnknownSpace>;
  std::map<Key, LoadedScene> scenes_;
};

/// Loads one scene and measures the time.
LoadedScene load_timed(const std::string& name, const std::string& file,
                       const scene::SnapshotOptions& options);

}  // namespace camway::tools
