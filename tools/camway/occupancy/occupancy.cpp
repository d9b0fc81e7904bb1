// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>

#include "daemon/cli_support/flag_checks.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/daemon_failure.h"
#include "tools/camway/common/key_file.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/camway/occupancy/occupancy_queries.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

struct OccupancyFlags {
  SceneFlags scene;
  std::string daemon_scene;
  std::string url;
  std::string prefix = "CAMWAY";
  std::string key_file;
  std::optional<double> timeout_s;
  double deadline_s = 0.0;  ///< 0: the daemon's
  std::optional<double> resolution_m;
  OccupancyTexts queries;
  std::string map_file;
};

ExitCode ask_map(const OccupancyFlags& flags, const OccupancyBatch& batch) {
  scene::SnapshotOptions options;
  options.import = flags.scene.import_options();
  options.occupancy_resolution_m = flags.resolution_m;
  const LoadedScene loaded =
      load_timed(flags.scene.file, flags.scene.file, options, user_cache(flags.scene));
  if (!loaded.result.snapshot) {
    print_error(loaded.result.error);
    return ExitCode::kInvalidInput;
  }
  const scene::SceneMirror& map = *loaded.result.snapshot->occupancy;
  const scene::OccupancyStatistics statistics = map.statistics();
  print_error(fmt::format("{} occupied voxels of {} m", statistics.occupied_voxels,
                          statistics.resolution_m));
  fmt::print("{}", describe(flags.queries, answer_offline(map, batch)));
  if (flags.map_file.empty()) return ExitCode::kSuccess;
  const std::string error = map.write_bt(flags.map_file);
  if (error.empty()) return ExitCode::kSuccess;
  print_error(error);
  return ExitCode::kInvalidInput;
}

ExitCode ask_daemon(const OccupancyFlags& flags, OccupancyBatch batch) {
  ClientOptions options;
  options.url = flags.url;
  options.prefix = flags.prefix;
  use_timeout(flags.timeout_s, options);
  if (const std::string fault = use_key_file(flags.key_file, options); !fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  Client client(options);
  if (!client.good()) {
    print_error(client.error());
    return ExitCode::kInvalidInput;
  }
  batch.scene = flags.daemon_scene;
  batch.deadline_s = flags.deadline_s;
  const OccupancyAnswer answer = client.occupancy(batch);
  if (!answer.ok()) return report_failure(answer.status, answer.error, flags.key_file);
  print_error(fmt::format("scene {}, revision {}, voxels of {} m", flags.daemon_scene,
                          answer.scene_revision, answer.resolution_m));
  fmt::print("{}", describe(flags.queries, answer));
  return ExitCode::kSuccess;
}

ExitCode run_occupancy(const OccupancyFlags& flags) {
  const base::Result<OccupancyBatch> parsed = parse_batch(flags.queries);
  std::string error = parsed.error;
  if (error.empty() && flags.scene.file.empty() == flags.daemon_scene.empty()) {
    error = "either --scene FILE or --daemon NAME says whose occupancy is asked";
  } else if (error.empty() && !flags.scene.file.empty() && !flags.resolution_m) {
    error = "--scene needs --resolution, the edge of a voxel in metres";
  }
  if (error.empty() && !flags.map_file.empty()) {
    error = why_unwritable(flags.map_file, {flags.scene.file});
  }
  if (!error.empty()) {
    print_error(error);
    return ExitCode::kInvalidInput;
  }
  return flags.daemon_scene.empty() ? ask_map(flags, *parsed) : ask_daemon(flags, *parsed);
}

/// Adds an option for a query. It may be repeated, each time with one text.
void add_query(CLI::App& command, const char* name, std::vector<std::string>& texts,
               const char* type_name, const char* help) {
  command.add_option(name, texts, help)
      ->type_name(type_name)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_queries(CLI::App& command, OccupancyTexts& queries) {
  add_query(command, "--point", queries.points, "X,Y,Z", "Is the voxel that holds it occupied?");
  add_query(command, "--box", queries.boxes, "X,Y,Z,X,Y,Z",
            "Minimum and maximum: does an occupied voxel touch the box?");
  add_query(command, "--sphere", queries.spheres, "X,Y,Z,R",
            "Center and radius: does an occupied voxel touch the ball?");
  add_query(command, "--ray", queries.rays, "X,Y,Z,DX,DY,DZ,RANGE",
            "Origin, direction, range: how far is the first occupied voxel?");
  add_query(command, "--distance", queries.distances, "X,Y,Z,MAX",
            "Point and largest distance of interest: how far is the nearest occupied voxel?");
  add_query(command, "--sphere-path", queries.sphere_paths, "X,Y,Z,X,Y,Z,R",
            "Beginning, end, radius: how far does a ball get before it touches an occupied voxel?");
}

/// Adds the flags that say which map is asked. Returns the one that names a daemon's scene.
CLI::Option* add_map_flags(CLI::App& command, OccupancyFlags& flags) {
  CLI::Option* file = add_scene_flags(command, flags.scene);
  CLI::Option* resolution =
      command.add_option("--resolution", flags.resolution_m, "Edge of a voxel, with --scene")
          ->check(cli_support::above_0())
          ->type_name("METRES");
  return command
      .add_option("--daemon", flags.daemon_scene,
                  "Ask a running daemon about its scene of this name, over LCM")
      ->type_name("NAME")
      ->excludes(file)
      ->excludes(resolution);
}

/// Adds the flags that say how a daemon is asked.
void add_daemon_flags(CLI::App& command, OccupancyFlags& flags, CLI::Option* daemon) {
  command.add_option("--url", flags.url, "LCM network, with --daemon [LCM_DEFAULT_URL]")
      ->needs(daemon);
  command.add_option("--prefix", flags.prefix, "Prefix of the daemon's channels")
      ->needs(daemon)
      ->capture_default_str();
  add_key_file(command, flags.key_file)->needs(daemon);
  add_timeout(command, flags.timeout_s)->needs(daemon);
  command
      .add_option("--deadline-s", flags.deadline_s,
                  "How long the daemon may take for each message of queries, seconds; 0: its own")
      ->check(cli_support::at_least_0())
      ->needs(daemon)
      ->capture_default_str();
}

}  // namespace

void add_occupancy_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<OccupancyFlags>();
  CLI::App* command = app.add_subcommand(
      "occupancy", "Ask the occupancy map of a scene, in this process or of a running daemon");
  CLI::Option* daemon = add_map_flags(*command, *flags);
  add_daemon_flags(*command, *flags, daemon);
  add_queries(*command, flags->queries);
  command
      ->add_option("--write", flags->map_file,
                   "Write the map as OctoMap's .bt, which octovis opens; with --scene")
      ->type_name("FILE")
      ->excludes(daemon);
  command->footer(exit_code_help("the daemon's deadline came first", /*asks_daemon=*/true) +
                  "\nCoordinates are metres in the scene's frame; write --point=-1,2,3 if the "
                  "first is negative."
                  "\nExample: camway occupancy --scene scenes/office.obj --resolution 0.1 --point "
                  "3,1.5,4 --write office.bt");
  command->callback([flags, &exit_code] { exit_code = run_occupancy(*flags); });
}

}  // namespace camway::tools
