// SPDX-License-Identifier: MIT
#include "tools/camway/scene/scene_calls.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/process/settings/bounds_text.h"
#include "tools/camway/common/daemon_failure.h"
#include "tools/camway/common/interruption.h"
#include "tools/camway/common/key_file.h"
#include "tools/camway/scene/scene_text.h"
#include "tools/support/client_request.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

/// Time to wait for the next daemon after a stopping one refuses a change: more than a heartbeat.
constexpr double kSuccessorWait_s = 1.5;

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
  mesh.voxel_m = flags.voxel_m;
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

/// Returns the present pose of the object; any pose if there is no such object, for which the
/// change then fails.
SceneAnswer find_pose(Client& client, const SceneCommandFlags& flags, Pose& pose) {
  SceneAnswer answer = client.describe_scene(flags.scene);
  for (const SceneObject& object : answer.objects) {
    if (object.name == flags.object) pose = object.pose;
  }
  return answer;
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

}  // namespace

ExitCode ask_daemon(const SceneCommandFlags& flags,
                    const std::function<SceneAnswer(Client&)>& call) {
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

ExitCode load_scene(const SceneCommandFlags& flags) {
  const std::optional<SceneMesh> mesh = mesh_of(flags);
  if (!mesh) return ExitCode::kInvalidInput;
  Bounds bounds;
  if (!flags.bounds.empty()) {
    const base::Result<geometry::Bounds> parsed = process::parse_bounds(flags.bounds);
    if (!parsed) {
      print_error("--bounds: " + parsed.error);
      return ExitCode::kInvalidInput;
    }
    bounds = to_client_bounds(*parsed);
  }
  return ask_daemon(flags, [&](Client& client) {
    return client.load_scene(flags.scene, *mesh, flags.occupancy_m, bounds);
  });
}

ExitCode add_object(const SceneCommandFlags& flags) {
  const std::optional<SceneShape> shape = shape_of(flags);
  if (!shape) return ExitCode::kInvalidInput;
  if (const std::string fault = fault_in_pose(flags); !fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  return ask_daemon(flags, [&](Client& client) {
    return client.put_object(flags.scene, flags.object, *shape, pose_of(flags, {}));
  });
}

ExitCode move_object(const SceneCommandFlags& flags) {
  const bool has_all = !flags.position_m.empty() && !flags.orientation_wxyz.empty();
  std::string fault = fault_in_pose(flags);
  if (flags.position_m.empty() && flags.orientation_wxyz.empty()) {
    fault = "--position, --orientation or both say where the object is to be";
  }
  if (!fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  return ask_daemon(flags, [&](Client& client) {
    Pose pose;
    if (!has_all) {
      SceneAnswer described = find_pose(client, flags, pose);
      if (!described.ok()) return described;
    }
    return client.move_object(flags.scene, flags.object, pose_of(flags, pose));
  });
}

ExitCode insert_scan(const SceneCommandFlags& flags) {
  const auto points = read_points(flags.points_file);
  if (!points) return ExitCode::kInvalidInput;
  const std::array<double, 3> origin{flags.origin_m[0], flags.origin_m[1], flags.origin_m[2]};
  return ask_daemon(flags, [&](Client& client) {
    return client.insert_scan(flags.scene, flags.object, *points, origin);
  });
}

ExitCode export_map(const SceneCommandFlags& flags) {
  if (flags.to_file.empty() == flags.file.empty()) {
    print_error("either --to or --file says where the map goes");
    return ExitCode::kInvalidInput;
  }
  if (!flags.file.empty()) {
    return ask_daemon(
        flags, [&](Client& client) { return client.export_map_to(flags.scene, flags.file); });
  }
  SceneMap map;
  const ExitCode code = ask_daemon(flags, [&](Client& client) {
    map = client.export_map(flags.scene);
    SceneAnswer asked;
    asked.status = map.status;
    asked.error = map.error;
    return asked;
  });
  return map.ok() ? save_map(map, flags.to_file) : code;
}

}  // namespace camway::tools
