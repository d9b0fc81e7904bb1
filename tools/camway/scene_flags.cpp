// SPDX-License-Identifier: MIT
#include "tools/camway/scene_flags.h"

#include <chrono>

namespace camway::tools {
namespace {

const std::map<std::string, scene::UpAxis> kUpAxes{{"as-in-file", scene::UpAxis::kAsInFile},
                                                   {"z-to-y", scene::UpAxis::kZToY},
                                                   {"y-to-z", scene::UpAxis::kYToZ}};

const std::map<std::string, scene::UnknownSpace> kUnknown{
    {"free", scene::UnknownSpace::kFree}, {"occupied", scene::UnknownSpace::kOccupied}};

}  // namespace

scene::ImportOptions SceneFlags::import_options() const {
  scene::ImportOptions options;
  options.scale = scale;
  options.up = up;
  options.unknown = unknown;
  return options;
}

CLI::Option* add_scene_flags(CLI::App& command, SceneFlags& flags) {
  command
      .add_option("--scale", flags.scale,
                  "Metres per unit of the scene file (0.0254 for inches); multiplies coordinates")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--up", flags.up,
                  "Turn the axes: z-to-y for a file with Z up and keyframes with Y up, y-to-z for "
                  "the reverse [as-in-file]")
      ->transform(CLI::CheckedTransformer(kUpAxes).description("as-in-file|z-to-y|y-to-z"))
      ->type_name("AXES");
  command
      .add_option("--unknown", flags.unknown,
                  "What an OctoMap (.bt, .ot) knows nothing of counts as free or occupied [free]")
      ->transform(CLI::CheckedTransformer(kUnknown).description("free|occupied"))
      ->type_name("STATE");
  return command
      .add_option("--scene", flags.file, "Scene file (OBJ, OFF, PLY, STL, glTF, OctoMap, ...)")
      ->type_name("FILE");
}

std::string_view to_string(scene::UpAxis up) {
  for (const auto& [name, value] : kUpAxes) {
    if (value == up) return name;
  }
  return "unknown";
}

const LoadedScene& SceneCache::load(const std::string& file) {
  const auto found = scenes_.find(file);
  if (found != scenes_.end()) return found->second;
  return scenes_.emplace(file, load_timed(file, file, options_)).first->second;
}

LoadedScene load_timed(const std::string& name, const std::string& file,
                       const scene::SnapshotOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  LoadedScene loaded;
  loaded.result = scene::load_snapshot(name, file, options);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  loaded.load_ms = taken.count();
  return loaded;
}

}  // namespace camway::tools
