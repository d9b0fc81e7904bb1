// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <fmt/format.h>

#include <memory>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/process/settings/bounds_text.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/scene/voxels/voxel_grid.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/daemon_failure.h"
#include "tools/camway/common/key_file.h"
#include "tools/camway/scene/scene_calls.h"
#include "tools/camway/scene/scene_command_flags.h"

namespace camway::tools {
namespace {

using Flags = std::shared_ptr<SceneCommandFlags>;

CLI::App* add_command(CLI::App& parent, const Flags& flags, const char* name, const char* help) {
  CLI::App* command = parent.add_subcommand(name, help);
  command->add_option("--url", flags->url, "LCM network [LCM_DEFAULT_URL]");
  command->add_option("--prefix", flags->prefix, "Prefix of the daemon's channels")
      ->capture_default_str();
  add_key_file(*command, flags->key_file);
  add_timeout(*command, flags->timeout_s);
  return command;
}

/// Adds a subcommand that changes a scene or may take long for other reasons.
CLI::App* add_change(CLI::App& parent, const Flags& flags, const char* name, const char* help) {
  CLI::App* command = add_command(parent, flags, name, help);
  command
      ->add_option("--deadline-s", flags->deadline_s,
                   "How long the daemon may take; then, and on Ctrl-C, it leaves all as it was. "
                   "Seconds; 0: its own")
      ->check(cli_support::at_least_0())
      ->capture_default_str();
  return command;
}

void add_scene_name(CLI::App& command, const Flags& flags) {
  command.add_option("SCENE", flags->scene, "Name of the scene in the daemon")->required();
}

void add_object_name(CLI::App& command, const Flags& flags) {
  command.add_option("OBJECT", flags->object, "Name of the object in the scene")->required();
}

void add_mesh_flags(CLI::App& command, const Flags& flags) {
  CLI::Option* file = command
                          .add_option("--file", flags->file,
                                      "Mesh, OctoMap or cloud of points that the daemon reads, "
                                      "below one of its --scene-roots")
                          ->type_name("FILE");
  command
      .add_option("--upload", flags->upload_file,
                  "Mesh, OctoMap or cloud of points here, sent to the daemon")
      ->type_name("FILE")
      ->excludes(file);
  command.add_option("--scale", flags->scale, "Metres per unit of the file")
      ->check(cli_support::above_0())
      ->capture_default_str();
  static constexpr std::array<std::pair<std::string_view, SceneMesh::Up>, 3> kUpAxes{
      {{"as-in-file", SceneMesh::Up::kAsInFile},
       {"z-to-y", SceneMesh::Up::kZToY},
       {"y-to-z", SceneMesh::Up::kYToZ}}};
  cli_support::add_choice(command, "--up", flags->up, kUpAxes,
                          "Turn the axes: z-to-y or y-to-z [as-in-file]")
      ->type_name("AXES");
  static constexpr std::array<std::pair<std::string_view, SceneMesh::Unknown>, 2> kUnknown{
      {{"free", SceneMesh::Unknown::kFree}, {"occupied", SceneMesh::Unknown::kOccupied}}};
  cli_support::add_choice(command, "--unknown", flags->unknown, kUnknown,
                          "What an OctoMap knows nothing of counts as free or occupied [free]")
      ->type_name("STATE");
  command
      .add_option("--voxel-m", flags->voxel_m,
                  "Edge of the voxels that the points of a cloud (.pcd, .xyz, .las) become, metres "
                  "[about twice the distance of neighbouring points]")
      ->type_name("METRES")
      ->check(cli_support::between(scene::VoxelGrid::kMinResolutionM,
                                   scene::VoxelGrid::kMaxResolutionM));
}

/// Returns the lengths of shapes that a daemon takes.
cli_support::NumberRange length_range() {
  return {fmt::format("above 0 and at most {:g} m", scene::kLargestShapeM),
          [](double length_m) { return length_m > 0.0 && length_m <= scene::kLargestShapeM; }};
}

/// `otherwise` describes the value without the flag.
void add_pose_flags(CLI::App& command, const Flags& flags, const char* otherwise) {
  const std::string unsaid = std::string(" [") + otherwise + "]";
  cli_support::add_numbers(command, "--position", flags->position_m, "X,Y,Z",
                           "Of the object's origin, metres" + unsaid);
  cli_support::add_numbers(command, "--orientation", flags->orientation_wxyz, "W,X,Y,Z",
                           "Turns the object's axes" + unsaid);
}

void add_shape_flags(CLI::App& command, const Flags& flags) {
  cli_support::add_numbers(command, "--box", flags->box_m, "X,Y,Z",
                           "A box of this size about its origin, metres", length_range());
  command.add_option("--sphere", flags->sphere_m, "A sphere of this radius, metres")
      ->type_name("RADIUS")
      ->check(cli_support::number_in(length_range()));
  cli_support::add_numbers(command, "--cylinder", flags->cylinder_m, "RADIUS,HEIGHT",
                           "A cylinder of this radius and height along z, about its middle, metres",
                           length_range());
  command.add_option("--map", flags->map_m, "An OctoMap of this resolution, for scans; metres")
      ->type_name("RESOLUTION")
      ->check(cli_support::between(scene::VoxelGrid::kMinResolutionM,
                                   scene::VoxelGrid::kMaxResolutionM));
  command
      .add_option("--hit", flags->sensor.hit_probability, "With --map: of a voxel that was seen")
      ->check(cli_support::number_in(
          {"above 0.5 and below 1", [](double p) { return p > 0.5 && p < 1.0; }}))
      ->capture_default_str();
  command
      .add_option("--miss", flags->sensor.miss_probability,
                  "With --map: of a voxel that was seen through")
      ->check(cli_support::number_in(
          {"above 0 and below 0.5", [](double p) { return p > 0.0 && p < 0.5; }}))
      ->capture_default_str();
  command
      .add_option("--max-range", flags->sensor.max_range_m,
                  "With --map: points further away only say what is free up to there, metres [all "
                  "count]")
      ->check(cli_support::above_0());
  command
      .add_option("--chord-error", flags->chord_error_m,
                  "How far the triangles about a sphere or cylinder may stand out, metres [a "
                  "hundredth of the radius]")
      ->check(cli_support::number_in(length_range()));
}

void add_load(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* command =
      add_change(parent, flags, "load", "Load a scene from a file, or make one without objects");
  add_scene_name(*command, flags);
  add_mesh_flags(*command, flags);
  command->add_option("--occupancy", flags->occupancy_m,
                      "Edge of a voxel of its occupancy map, metres [no map]");
  command
      ->add_option("--bounds", flags->bounds,
                   "What no body may leave in it, whatever a request says, metres; a number that "
                   "is left out is no limit, as in -3..3/0..2.6/.. [no limits]")
      ->type_name(process::kBoundsForm);
  command->callback([flags, &exit_code] { exit_code = load_scene(*flags); });
}

void add_changes(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* add = add_change(parent, flags, "add", "Add an object, or replace the one of its name");
  add_scene_name(*add, flags);
  add_object_name(*add, flags);
  add_mesh_flags(*add, flags);
  add_shape_flags(*add, flags);
  add_pose_flags(*add, flags, "as in the file, or at the origin");
  add->callback([flags, &exit_code] { exit_code = add_object(*flags); });

  CLI::App* move = add_change(parent, flags, "move", "Put an object elsewhere, or turn it");
  add_scene_name(*move, flags);
  add_object_name(*move, flags);
  add_pose_flags(*move, flags, "as it is; one of both is needed");
  move->callback([flags, &exit_code] { exit_code = move_object(*flags); });

  CLI::App* remove = add_change(parent, flags, "remove", "Take an object out of a scene");
  add_scene_name(*remove, flags);
  add_object_name(*remove, flags);
  remove->callback([flags, &exit_code] {
    exit_code = ask_daemon(
        *flags, [&](Client& client) { return client.remove_object(flags->scene, flags->object); });
  });
}

void add_list(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* list = add_command(parent, flags, "list", "List the daemon's scenes");
  list->callback([flags, &exit_code] {
    bool is_empty = false;
    exit_code = ask_daemon(*flags, [&](Client& client) {
      SceneAnswer answer = client.list_scenes();
      is_empty = answer.ok() && answer.scenes.empty();
      return answer;
    });
    if (is_empty) fmt::print("the daemon holds no scenes\n");
  });
}

void add_describe(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* describe = add_command(parent, flags, "describe", "List the objects of a scene");
  add_scene_name(*describe, flags);
  describe->callback([flags, &exit_code] {
    exit_code =
        ask_daemon(*flags, [&](Client& client) { return client.describe_scene(flags->scene); });
  });
}

void add_scan(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* scan =
      add_change(parent, flags, "scan", "Tell an object that is an OctoMap what a sensor saw");
  add_scene_name(*scan, flags);
  add_object_name(*scan, flags);
  scan->add_option("--points", flags->points_file, "Three numbers a line, metres in the world")
      ->type_name("FILE")
      ->required();
  cli_support::add_numbers(*scan, "--origin", flags->origin_m, "X,Y,Z",
                           "Where the sensor was, metres in the world")
      ->required();
  scan->callback([flags, &exit_code] { exit_code = insert_scan(*flags); });
}

void add_export(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* out = add_change(parent, flags, "export",
                             "Write a scene's occupancy map as OctoMap's .bt, which octovis opens");
  add_scene_name(*out, flags);
  CLI::Option* to = out->add_option("--to", flags->to_file, "File here")->type_name("FILE");
  out->add_option("--file", flags->file,
                  "File that the daemon writes, below one of its --scene-roots; NAME.bt")
      ->type_name("FILE")
      ->excludes(to);
  out->callback([flags, &exit_code] { exit_code = export_map(*flags); });
}

void add_history(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* history = add_command(parent, flags, "history",
                                  "List the revisions of a scene that the daemon can restore");
  add_scene_name(*history, flags);
  history->callback([flags, &exit_code] {
    exit_code =
        ask_daemon(*flags, [&](Client& client) { return client.scene_history(flags->scene); });
  });
}

void add_unload(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* unload = add_change(parent, flags, "unload", "Let the daemon forget a scene");
  add_scene_name(*unload, flags);
  unload->callback([flags, &exit_code] {
    exit_code =
        ask_daemon(*flags, [&](Client& client) { return client.unload_scene(flags->scene); });
    if (exit_code == ExitCode::kSuccess) fmt::print("{} is unloaded\n", flags->scene);
  });
}

void add_restore(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* command =
      add_change(parent, flags, "restore",
                 "Make a new revision with the objects of an earlier one, which `history` lists");
  add_scene_name(*command, flags);
  command->add_option("--revision", flags->revision, "The earlier one")
      ->check(cli_support::whole_number(1))
      ->required();
  command
      ->add_option("--as", flags->restore_as,
                   "Name of another scene that is made of them, or replaced [SCENE itself]")
      ->type_name("NAME");
  command->callback([flags, &exit_code] {
    exit_code = ask_daemon(*flags, [&](Client& client) {
      return client.restore_scene(flags->scene, flags->revision, flags->restore_as);
    });
  });
}

}  // namespace

void add_scene_command(CLI::App& app, ExitCode& exit_code) {
  CLI::App* scene = app.add_subcommand("scene",
                                       "Look at the scenes of a running daemon and change "
                                       "them, over LCM");
  scene->require_subcommand(1);
  scene->footer(
      exit_code_help("the deadline passed, or it was cancelled; nothing was changed",
                     /*asks_daemon=*/true) +
      "\nWrite --position=-1,2,3 if the first number is negative."
      "\nExample: camway scene load hall --upload scenes/maze.obj && camway scene add hall crate "
      "--box 1,1,1 --position 4,0.5,2 && camway scene move hall crate --position 5,0.5,2");
  const auto flags = std::make_shared<SceneCommandFlags>();
  add_load(*scene, flags, exit_code);
  add_changes(*scene, flags, exit_code);
  add_restore(*scene, flags, exit_code);
  add_list(*scene, flags, exit_code);
  add_describe(*scene, flags, exit_code);
  add_scan(*scene, flags, exit_code);
  add_export(*scene, flags, exit_code);
  add_history(*scene, flags, exit_code);
  add_unload(*scene, flags, exit_code);
}

}  // namespace camway::tools
