// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/process/settings/bounds_text.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/scene/voxels/voxel_grid.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/daemon_failure.h"
#include "tools/camway/common/interruption.h"
#include "tools/camway/common/key_file.h"
#include "tools/support/client_request.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

/// Time to wait for the next daemon after a stopping one refuses a change: more than a heartbeat.
constexpr double kSuccessorWait_s = 1.5;

/// Options of the subcommands of `camway scene`.
struct SceneCommandFlags {
  std::string url;
  std::string prefix = "CAMWAY";
  std::string key_file;
  std::optional<double> timeout_s;
  double deadline_s = ClientOptions{}.change_deadline_s;
  std::string scene;
  std::string object;
  std::string file;         ///< below a root of the daemon
  std::string upload_file;  ///< here
  std::string to_file;      ///< here, written
  std::int64_t revision = 0;
  std::string restore_as;
  double scale = 1.0;
  SceneMesh::Up up = SceneMesh::Up::kAsInFile;
  SceneMesh::Unknown unknown = SceneMesh::Unknown::kFree;
  double occupancy_m = 0.0;
  std::string bounds;
  std::vector<double> box_m;
  std::vector<double> cylinder_m;
  std::optional<double> sphere_m;
  double chord_error_m = 0.0;
  std::optional<double> map_m;
  SceneSensor sensor;
  std::string points_file;
  std::vector<double> origin_m;
  std::vector<double> position_m;  ///< empty: not given, as the next
  std::vector<double> orientation_wxyz;
};

using Flags = std::shared_ptr<SceneCommandFlags>;

/// Returns the box that no body may leave in the scene.
std::string bounds_note(const SceneInfo& scene) {
  const geometry::Bounds bounds = from_client_bounds(scene.body_bounds);
  return bounds.any() ? ", bodies within " + process::bounds_text(bounds) : std::string();
}

void print_scene(const SceneInfo& scene) {
  fmt::print(
      "{} revision {}: {} triangles, [{:.3f}, {:.3f}, {:.3f}] to [{:.3f}, {:.3f}, {:.3f}] "
      "m, {}{}, digest {}\n",
      scene.name, scene.revision, scene.num_triangles, scene.bounds_min_m[0], scene.bounds_min_m[1],
      scene.bounds_min_m[2], scene.bounds_max_m[0], scene.bounds_max_m[1], scene.bounds_max_m[2],
      scene.occupancy_resolution_m > 0.0
          ? fmt::format("voxels of {} m", scene.occupancy_resolution_m)
          : "no occupancy map",
      bounds_note(scene), scene.digest);
}

void print_object(const SceneObject& object) {
  const Pose& pose = object.pose;
  fmt::print(
      "  {}: {}, {} triangles, at [{:.6g}, {:.6g}, {:.6g}] m, turned [{:.6g}, {:.6g}, "
      "{:.6g}, {:.6g}], digest {}\n",
      object.name, object.kind, object.num_triangles, pose.position_m[0], pose.position_m[1],
      pose.position_m[2], pose.orientation_wxyz[0], pose.orientation_wxyz[1],
      pose.orientation_wxyz[2], pose.orientation_wxyz[3], object.digest);
}

void print_revision(const SceneRevision& revision) {
  constexpr std::int64_t kMicrosecondsPerSecond = 1'000'000;
  const std::time_t when = revision.utime / kMicrosecondsPerSecond;
  std::string what = revision.operation;
  if (!revision.object.empty()) what += " " + revision.object;
  if (revision.restored_revision > 0) what += fmt::format(" of {}", revision.restored_revision);
  fmt::print("  {}: {:%Y-%m-%dT%H:%M:%SZ}, {}, by {}\n", revision.revision, fmt::gmtime(when), what,
             revision.client_id.empty() ? "the daemon" : revision.client_id);
}

/// Returns the error of a daemon ("invalid: chord_error_m: ...") with the flag in place of the
/// member of the message. The values of other flags are checked before.
std::string named_as_flag(std::string error) {
  for (const auto& [member, flag] :
       {std::pair{"invalid: chord_error_m:", "--chord-error:"},
        std::pair{"invalid: occupancy_resolution_m:", "--occupancy:"}}) {
    if (error.starts_with(member)) return error.replace(0, std::strlen(member), flag);
  }
  return error;
}

ExitCode print_answer(const SceneAnswer& answer, const std::string& key_file) {
  if (!answer.ok()) return report_failure(answer.status, named_as_flag(answer.error), key_file);
  if (!answer.message.empty()) print_error(answer.message);
  if (!answer.scene.name.empty()) print_scene(answer.scene);
  for (const SceneInfo& scene : answer.scenes) print_scene(scene);
  for (const SceneObject& object : answer.objects) print_object(object);
  for (const SceneRevision& revision : answer.revisions) print_revision(revision);
  return ExitCode::kSuccess;
}

/// Reads the bytes of a file and its extension.
bool read_upload(const std::string& file, SceneMesh& mesh) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 65536> part;
  while (in.read(part.data(), part.size()) || in.gcount() > 0) {
    mesh.bytes.insert(mesh.bytes.end(), part.begin(), part.begin() + in.gcount());
  }
  // A folder can be opened, but not be read.
  if (!in.is_open() || in.bad()) {
    print_error("cannot read '" + file + "'");
    return false;
  }
  if (mesh.bytes.empty()) {
    print_error("'" + file + "' is empty");
    return false;
  }
  const std::size_t dot = file.rfind('.');
  mesh.format = dot == std::string::npos ? "" : file.substr(dot + 1);
  for (char& c : mesh.format) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return true;
}

/// Returns the mesh that the flags name. If its file cannot be read, prints the reason and returns
/// nothing.
std::optional<SceneMesh> mesh_of(const SceneCommandFlags& flags) {
  SceneMesh mesh;
  mesh.file = flags.file;
  mesh.scale = flags.scale;
  mesh.up = flags.up;
  mesh.unknown = flags.unknown;
  if (!flags.upload_file.empty() && !read_upload(flags.upload_file, mesh)) return std::nullopt;
  return mesh;
}

std::optional<SceneShape> shape_of(const SceneCommandFlags& flags) {
  const bool is_mesh = !flags.file.empty() || !flags.upload_file.empty();
  const int shapes = (is_mesh ? 1 : 0) + (flags.box_m.empty() ? 0 : 1) + (flags.sphere_m ? 1 : 0) +
                     (flags.cylinder_m.empty() ? 0 : 1) + (flags.map_m ? 1 : 0);
  if (shapes != 1) {
    print_error("one of --file, --upload, --box, --sphere, --cylinder and --map says what to add" +
                std::string(shapes > 1 ? ", and no more than one" : ""));
    return std::nullopt;
  }
  if (!flags.box_m.empty()) return SceneBox{{flags.box_m[0], flags.box_m[1], flags.box_m[2]}};
  if (flags.sphere_m) return SceneSphere{*flags.sphere_m, flags.chord_error_m};
  if (!flags.cylinder_m.empty()) {
    return SceneCylinder{flags.cylinder_m[0], flags.cylinder_m[1], flags.chord_error_m};
  }
  if (flags.map_m) return SceneVoxels{*flags.map_m, flags.unknown, flags.sensor};
  if (std::optional<SceneMesh> mesh = mesh_of(flags)) return *std::move(mesh);
  return std::nullopt;
}

/// Returns the fault of the flags for a pose; empty if there is none.
std::string fault_in_pose(const SceneCommandFlags& flags) {
  if (flags.orientation_wxyz.empty()) return {};
  double largest = 0.0;
  for (const double part : flags.orientation_wxyz) largest = std::max(largest, std::abs(part));
  return largest > 0.0 ? std::string()
                       : "--orientation: 0,0,0,0 is no quaternion of a turn; 1,0,0,0 turns nothing";
}

/// Returns `pose` with the changes of the flags.
Pose pose_of(const SceneCommandFlags& flags, Pose pose) {
  std::ranges::copy(flags.position_m, pose.position_m.begin());
  std::ranges::copy(flags.orientation_wxyz, pose.orientation_wxyz.begin());
  return pose;
}

/// While this object exists, a signal to end cancels the client's call, and a second one ends the
/// process.
class CallOff {
 public:
  CallOff(const Interruption& interruption, Client& client)
      : thread_([&interruption, &client](const std::stop_token& stop) {
          constexpr long kLookMs = 50;
          for (bool is_cancelled = false; !stop.stop_requested();) {
            const bool came = interruption.came_within(kLookMs);
            if (came && is_cancelled) interruption.end_process();
            is_cancelled = is_cancelled || came;
            // Repeated, because the signal may have come before the client's call.
            if (is_cancelled) client.cancel_scene_calls();
          }
        }) {}

 private:
  std::jthread thread_;
};

/// Opens a client and runs `call` with it.
template <class Call>
ExitCode with_client(const SceneCommandFlags& flags, const Call& call) {
  ClientOptions options;
  options.url = flags.url;
  options.prefix = flags.prefix;
  use_timeout(flags.timeout_s, options);
  options.successor_wait_s = kSuccessorWait_s;
  options.change_deadline_s = flags.deadline_s;
  if (const std::string fault = use_key_file(flags.key_file, options); !fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  const Interruption interruption;
  Client client(options);
  if (!client.good()) {
    print_error(client.error());
    return ExitCode::kInvalidInput;
  }
  const CallOff call_off(interruption, client);
  return print_answer(call(client), flags.key_file);
}

ExitCode run_load(const SceneCommandFlags& flags) {
  const std::optional<SceneMesh> mesh = mesh_of(flags);
  if (!mesh) return ExitCode::kInvalidInput;
  Bounds bounds;
  if (!flags.bounds.empty()) {
    const process::ParsedBounds parsed = process::parse_bounds(flags.bounds);
    if (!parsed.bounds) {
      print_error("--bounds: " + parsed.error);
      return ExitCode::kInvalidInput;
    }
    bounds = to_client_bounds(*parsed.bounds);
  }
  return with_client(flags, [&](Client& client) {
    return client.load_scene(flags.scene, *mesh, flags.occupancy_m, bounds);
  });
}

ExitCode run_add(const SceneCommandFlags& flags) {
  const std::optional<SceneShape> shape = shape_of(flags);
  if (!shape) return ExitCode::kInvalidInput;
  if (const std::string fault = fault_in_pose(flags); !fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  return with_client(flags, [&](Client& client) {
    return client.put_object(flags.scene, flags.object, *shape, pose_of(flags, {}));
  });
}

/// Returns the present pose of the object; any pose if there is no such object, for which the
/// change then fails.
SceneAnswer find_pose(Client& client, const SceneCommandFlags& flags, Pose& pose) {
  SceneAnswer answer = client.describe_scene(flags.scene);
  for (const SceneObject& object : answer.objects) {
    if (object.name == flags.object) pose = object.pose;
  }
  return answer;
}

ExitCode run_move(const SceneCommandFlags& flags) {
  const bool has_all = !flags.position_m.empty() && !flags.orientation_wxyz.empty();
  std::string fault = fault_in_pose(flags);
  if (flags.position_m.empty() && flags.orientation_wxyz.empty()) {
    fault = "--position, --orientation or both say where the object is to be";
  }
  if (!fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  return with_client(flags, [&](Client& client) {
    Pose pose;
    if (!has_all) {
      SceneAnswer described = find_pose(client, flags, pose);
      if (!described.ok()) return described;
    }
    return client.move_object(flags.scene, flags.object, pose_of(flags, pose));
  });
}

/// Reads a file with three numbers on each line. If it is no such file, prints the reason and
/// returns nothing.
std::optional<std::vector<std::array<double, 3>>> read_points(const std::string& file) {
  std::ifstream in(file);
  std::vector<std::array<double, 3>> points;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::array<double, 3> point{};
    if ((words >> std::ws).eof() || words.peek() == '#') continue;
    if (!(words >> point[0] >> point[1] >> point[2])) {
      print_error(fmt::format("{}:{}: is no point: x y z", file, number));
      return std::nullopt;
    }
    points.push_back(point);
  }
  if (!points.empty()) return points;
  print_error("'" + file + "' holds no point, or cannot be read");
  return std::nullopt;
}

ExitCode run_scan(const SceneCommandFlags& flags) {
  const auto points = read_points(flags.points_file);
  if (!points) return ExitCode::kInvalidInput;
  const std::array<double, 3> origin{flags.origin_m[0], flags.origin_m[1], flags.origin_m[2]};
  return with_client(flags, [&](Client& client) {
    return client.insert_scan(flags.scene, flags.object, *points, origin);
  });
}

ExitCode save_map(const SceneMap& map, const std::string& file) {
  const std::string error =
      write_file(file, {reinterpret_cast<const char*>(map.bytes.data()), map.bytes.size()});
  if (!error.empty()) {
    print_error(error);
    return ExitCode::kInvalidInput;
  }
  print_scene(map.scene);
  return ExitCode::kSuccess;
}

ExitCode run_export(const SceneCommandFlags& flags) {
  if (flags.to_file.empty() == flags.file.empty()) {
    print_error("either --to or --file says where the map goes");
    return ExitCode::kInvalidInput;
  }
  if (!flags.file.empty()) {
    return with_client(
        flags, [&](Client& client) { return client.export_map_to(flags.scene, flags.file); });
  }
  SceneMap map;
  const ExitCode code = with_client(flags, [&](Client& client) {
    map = client.export_map(flags.scene);
    SceneAnswer asked;
    asked.status = map.status;
    asked.error = map.error;
    return asked;
  });
  return map.ok() ? save_map(map, flags.to_file) : code;
}

CLI::App* add_command(CLI::App& parent, const Flags& flags, const char* name, const char* help) {
  CLI::App* command = parent.add_subcommand(name, help);
  command->add_option("--url", flags->url, "LCM network [LCM_DEFAULT_URL]");
  command->add_option("--prefix", flags->prefix, "Of the daemon's channels")->capture_default_str();
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
  CLI::Option* file =
      command
          .add_option("--file", flags->file,
                      "Mesh or OctoMap file that the daemon reads, below one of its --scene-roots")
          ->type_name("FILE");
  command
      .add_option("--upload", flags->upload_file, "Mesh or OctoMap file here, sent to the daemon")
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
  command->callback([flags, &exit_code] { exit_code = run_load(*flags); });
}

void add_changes(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* add = add_change(parent, flags, "add", "Add an object, or replace the one of its name");
  add_scene_name(*add, flags);
  add_object_name(*add, flags);
  add_mesh_flags(*add, flags);
  add_shape_flags(*add, flags);
  add_pose_flags(*add, flags, "as in the file, or at the origin");
  add->callback([flags, &exit_code] { exit_code = run_add(*flags); });

  CLI::App* move = add_change(parent, flags, "move", "Put an object elsewhere, or turn it");
  add_scene_name(*move, flags);
  add_object_name(*move, flags);
  add_pose_flags(*move, flags, "as it is; one of both is needed");
  move->callback([flags, &exit_code] { exit_code = run_move(*flags); });

  CLI::App* remove = add_change(parent, flags, "remove", "Take an object out of a scene");
  add_scene_name(*remove, flags);
  add_object_name(*remove, flags);
  remove->callback([flags, &exit_code] {
    exit_code = with_client(
        *flags, [&](Client& client) { return client.remove_object(flags->scene, flags->object); });
  });
}

void add_looks(CLI::App& parent, const Flags& flags, ExitCode& exit_code) {
  CLI::App* list = add_command(parent, flags, "list", "List the daemon's scenes");
  list->callback([flags, &exit_code] {
    bool is_empty = false;
    exit_code = with_client(*flags, [&](Client& client) {
      SceneAnswer answer = client.list_scenes();
      is_empty = answer.ok() && answer.scenes.empty();
      return answer;
    });
    if (is_empty) fmt::print("the daemon holds no scenes\n");
  });

  CLI::App* describe = add_command(parent, flags, "describe", "List the objects of a scene");
  add_scene_name(*describe, flags);
  describe->callback([flags, &exit_code] {
    exit_code =
        with_client(*flags, [&](Client& client) { return client.describe_scene(flags->scene); });
  });

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
  scan->callback([flags, &exit_code] { exit_code = run_scan(*flags); });

  CLI::App* out = add_change(parent, flags, "export",
                             "Write a scene's occupancy map as OctoMap's .bt, which octovis opens");
  add_scene_name(*out, flags);
  CLI::Option* to = out->add_option("--to", flags->to_file, "File here")->type_name("FILE");
  out->add_option("--file", flags->file,
                  "File that the daemon writes, below one of its --scene-roots; NAME.bt")
      ->type_name("FILE")
      ->excludes(to);
  out->callback([flags, &exit_code] { exit_code = run_export(*flags); });

  CLI::App* history = add_command(parent, flags, "history",
                                  "List the revisions of a scene that the daemon can restore");
  add_scene_name(*history, flags);
  history->callback([flags, &exit_code] {
    exit_code =
        with_client(*flags, [&](Client& client) { return client.scene_history(flags->scene); });
  });

  CLI::App* unload = add_change(parent, flags, "unload", "Let the daemon forget a scene");
  add_scene_name(*unload, flags);
  unload->callback([flags, &exit_code] {
    exit_code =
        with_client(*flags, [&](Client& client) { return client.unload_scene(flags->scene); });
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
    exit_code = with_client(*flags, [&](Client& client) {
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
  add_looks(*scene, flags, exit_code);
}

}  // namespace camway::tools
