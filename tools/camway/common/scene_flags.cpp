// SPDX-License-Identifier: MIT
#include "tools/camway/common/scene_flags.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "daemon/base/named_enum.h"
#include "daemon/cli_support/flag_checks.h"
#include "daemon/scene/import/record/import_words.h"
#include "daemon/scene/voxels/voxel_grid.h"
#include "tools/camway/common/commands.h"

namespace camway::tools {
namespace {

/// Adds the flags, with the help of --scene and a text about the defaults.
CLI::Option* add_flags(CLI::App& command, SceneFlags& flags, const std::string& first) {
  command
      .add_option(
          "--scale", flags.reading.scale,
          "Metres per unit of the scene file (0.0254 for inches); multiplies coordinates [" +
              first + "1]")
      ->check(cli_support::above_0());
  cli_support::add_choice(
      command, "--up", flags.reading.up, base::named_values<scene::UpAxis>(),
      "Turn the axes: z-to-y for a file with Z up and keyframes with Y up, y-to-z for "
      "the reverse [" +
          first + "as-in-file]")
      ->type_name("AXES");
  cli_support::add_choice(
      command, "--unknown", flags.reading.unknown, base::named_values<scene::UnknownSpace>(),
      "What an OctoMap (.bt, .ot) knows nothing of counts as free or occupied [" + first + "free]")
      ->type_name("STATE");
  command
      .add_option("--voxel-m", flags.reading.voxel_m,
                  "Edge of the voxels that the points of a cloud (.pcd, .xyz, .las) become, metres "
                  "[" +
                      first + "about twice the distance of neighbouring points]")
      ->type_name("METRES")
      ->check(cli_support::between(scene::VoxelGrid::kMinResolutionM,
                                   scene::VoxelGrid::kMaxResolutionM));
  command.add_flag("--no-cache", flags.no_cache,
                   "Read and prepare the scene, even if the cache holds it, and do not keep it");
  return command
      .add_option("--scene", flags.file,
                  "Scene file (OBJ, OFF, PLY, STL, UniGrafix, STEP, IGES, Open Inventor, VRML, "
                  "glTF, OctoMap, PCD, LAS, ...)")
      ->type_name("FILE");
}

}  // namespace

scene::ImportOptions SceneFlags::import_options(const SceneReading& of_request) const {
  scene::ImportOptions options;
  const auto choose = [](const auto& flag, const auto& requested, auto& value) {
    if (const auto& said = flag ? flag : requested) value = *said;
  };
  choose(reading.scale, of_request.scale, options.scale);
  choose(reading.up, of_request.up, options.up);
  choose(reading.unknown, of_request.unknown, options.unknown);
  choose(reading.voxel_m, of_request.voxel_m, options.voxel_m);
  return options;
}

std::string SceneFlags::file_for(const std::string& request_file,
                                 const planning::PlanRequest& request) const {
  if (!file.empty() || request.scene.empty()) return file;
  if (request_file == "-") return request.scene;
  return (std::filesystem::path(request_file).parent_path() / request.scene).string();
}

CLI::Option* add_scene_flags(CLI::App& command, SceneFlags& flags) {
  return add_flags(command, flags, "");
}

void add_request_scene_flags(CLI::App& command, SceneFlags& flags) {
  add_flags(command, flags, "the request's, else ")
      ->description(
          "Scene file (OBJ, OFF, PLY, STL, UniGrafix, STEP, IGES, Open Inventor, VRML, glTF, "
          "OctoMap, PCD, LAS, ...) [the request's, which is relative to the request's folder]");
}

void warn_of_reading(const std::string& request_file, const RequestFile& request) {
  const SceneReading& reading = request.reading;
  if (!reading.scale && !reading.up && !reading.unknown && !reading.voxel_m) return;
  print_error("warning: " + request_file +
              ": scale, up, unknown and voxel_m do not count here: the scene is as it was loaded");
}

std::string_view to_string(scene::UpAxis up) { return base::name_of(up); }

std::optional<scene::SceneCache> user_cache(const SceneFlags& flags) {
  if (flags.no_cache) return std::nullopt;
  scene::UserCache user = scene::cache_of_environment();
  if (!user.cache) return std::nullopt;
  if (!user.fault.empty()) {
    print_error(fmt::format("warning: {}, so the cache of scenes may take {}", user.fault,
                            user.cache->limits().bytes));
  }
  const std::string fault = user.cache->fault();
  if (fault.empty()) return std::move(user.cache);
  print_error("warning: " + user.cache->folder().string() + ": " + fault +
              ", so it is not used as the cache of scenes");
  return std::nullopt;
}

const LoadedScene& LoadedScenes::load(const std::string& file, const scene::ImportOptions& import) {
  const Key key{file, import.scale, import.up, import.unknown, import.voxel_m};
  const auto found = scenes_.find(key);
  if (found != scenes_.end()) return found->second;
  scene::SnapshotOptions options;
  options.import = import;
  return scenes_.emplace(key, load_timed(file, file, options, cache_)).first->second;
}

LoadedScene load_timed(const std::string& name, const std::string& file,
                       const scene::SnapshotOptions& options,
                       const std::optional<scene::SceneCache>& cache) {
  const auto start = std::chrono::steady_clock::now();
  LoadedScene loaded;
  loaded.result = scene::load_snapshot(name, file, options, {}, cache ? &*cache : nullptr);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  loaded.load_ms = taken.count();
  return loaded;
}

}  // namespace camway::tools
