// SPDX-License-Identifier: MIT
// The main part of ./demo: requests paths from a running daemon, prints the results and draws one.
//
//   camway_demo SCENE_NAME SCENE_FILE OUT_DIR REQUEST.json...
//
// Exit code 0 if the daemon answered every request, the first one's path, which is drawn, is free
// of collision, and the picture was written; 1 if not; 2 for wrong arguments or files.
#include <camway/client.h>
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/scene/import/import.h"
#include "tools/demo/report.h"
#include "tools/drawing/floor_plan.h"
#include "tools/json/json_request.h"
#include "tools/support/client_request.h"

namespace camway::demo {
namespace {

constexpr double kHeartbeatPatience_s = 60.0;  // the daemon may be loading its scenes
constexpr std::size_t kDrawnSamples = 1500;

void print_error(const std::string& text) { fmt::print(stderr, "camway_demo: {}\n", text); }

/// A request and its answer.
struct Answered {
  std::string name;
  PlanRequest request;
  PlanResponse response;
};

bool from_daemon(const PlanResponse& response) {
  switch (response.status) {
    case Status::kOk:
    case Status::kPartial:
    case Status::kInfeasible:
    case Status::kTimeout:
      return true;
    default:
      return false;
  }
}

std::optional<Answered> ask(Client& client, const std::string& scene, const std::string& file) {
  const auto read = tools::read_as<tools::RequestFile>(file);
  if (!read) {
    print_error(read.error);
    return std::nullopt;
  }
  Answered answered;
  answered.name = std::filesystem::path(file).stem().string();
  answered.request = tools::to_client_request(*read, scene);
  answered.response = client.plan(answered.request);
  return answered;
}

/// Returns samples of the path as the client evaluates it, from the received numbers.
draw::SampledPath sample(const Path& path) {
  draw::SampledPath samples;
  for (std::size_t i = 0; i < kDrawnSamples; ++i) {
    const double share = static_cast<double>(i) / (kDrawnSamples - 1);
    const double time_s = path.begin() + share * (path.end() - path.begin());
    const Pose pose = path.pose(time_s);
    const auto& p = pose.position_m;
    const auto& q = pose.orientation_wxyz;
    samples.push_back({time_s, {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}}});
  }
  return samples;
}

std::vector<collision::CollisionInterval> to_collision(
    const std::vector<CollisionInterval>& intervals) {
  std::vector<collision::CollisionInterval> converted;
  for (const CollisionInterval& interval : intervals) {
    converted.push_back({interval.t_begin_s, interval.t_end_s});
  }
  return converted;
}

/// Draws an answer. Returns an error text, empty on success.
std::string draw_answer(const Answered& answered, scene::Mesh mesh, const std::string& folder) {
  const PlanResponse& response = answered.response;
  draw::FloorPlan plan;
  plan.title = answered.name;
  plan.subtitle = fmt::format("{}: {}", to_string(response.status), response.message);
  plan.mesh = std::move(mesh);
  plan.corners_C = motion::near_corners_C(to_motion(answered.request.camera));
  plan.keyframes = all_keyframes(response);
  plan.before = draw::sample(path_before(response), kDrawnSamples);
  plan.after = sample(response.path);
  plan.collisions = to_collision(response.collisions);
  plan.remaining_collisions = to_collision(response.remaining);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return folder + ": cannot be made: " + error.message();
  const std::filesystem::path base = std::filesystem::path(folder) / "demo";
  return draw::draw_floor_plan(plan, {base.string() + ".svg", base.string() + ".png"});
}

/// Plans all requests and prints a row for each. Returns the first answer if all were answered.
std::optional<Answered> ask_all(Client& client, const std::string& scene,
                                const std::vector<std::string>& files) {
  std::optional<Answered> first;
  bool all_answered = true;
  fmt::print("\n{}\n", table_head());
  for (const std::string& file : files) {
    std::optional<Answered> answered = ask(client, scene, file);
    if (!answered) return std::nullopt;
    const PlanResponse& response = answered->response;
    fmt::print("{}\n", table_row(answered->name, response));
    std::fflush(stdout);
    if (!from_daemon(response)) {
      print_error(answered->name + ": " + response.error);
      all_answered = false;
    }
    if (!first) first = std::move(answered);
  }
  return all_answered ? std::move(first) : std::nullopt;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 4) {
    print_error("needs SCENE_NAME SCENE_FILE OUT_DIR REQUEST.json...");
    return 2;
  }
  const scene::ImportResult scene = scene::import_mesh(arguments[1], {});
  if (!scene.mesh) {
    print_error(scene.error);
    return 2;
  }
  Client client;
  const DaemonStatus daemon = client.status(kHeartbeatPatience_s);
  if (!daemon.ok()) {
    print_error(daemon.error);
    return 1;
  }
  fmt::print("camwayd {} holds {} scene(s), {} workers\n", daemon.version, daemon.total_scenes,
             daemon.num_workers);
  const std::vector<std::string> files(arguments.begin() + 3, arguments.end());
  const std::optional<Answered> pictured = ask_all(client, arguments[0], files);
  if (!pictured) return 1;
  if (!pictured->response.ok()) {
    print_error(pictured->name + " should end ok: " + pictured->response.error);
    return 1;
  }
  const std::string error = draw_answer(*pictured, *scene.mesh, arguments[2]);
  if (!error.empty()) print_error(error);
  return error.empty() ? 0 : 1;
}

}  // namespace
}  // namespace camway::demo

int main(int argc, char** argv) { return camway::demo::run({argv + 1, argv + argc}); }
