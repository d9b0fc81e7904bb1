// SPDX-License-Identifier: MIT
#include "daemon/planning/check.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "daemon/collision/near_quad.h"
#include "tools/camway/commands.h"
#include "tools/camway/scene_flags.h"
#include "tools/json_io.h"

namespace camway::tools {
namespace {

struct CheckFlags {
  SceneFlags scene;
  std::string request;
  std::string response;
  bool json = false;
};

/// What a collision is with, in the middle of its interval.
struct Witness {
  std::string object;
  std::uint32_t triangle = 0;
};

/// All that a check needs, read and judged.
struct Input {
  planning::PlanRequest request;
  motion::Path path;
  motion::Corners corners_C{};
  std::shared_ptr<const scene::Snapshot> snapshot;
};

Parsed<Input> failed(std::string error) { return {std::nullopt, std::move(error)}; }

Parsed<Input> read_input(const CheckFlags& flags) {
  const Parsed<planning::PlanRequest> request = read_plan_request(flags.request);
  if (!request.value) return failed(request.error);
  if (const auto fault = planning::validate(*request.value)) {
    return failed(flags.request + ": " + describe(*fault));
  }
  const Parsed<planning::PlanResult> response = read_plan_response(flags.response);
  if (!response.value) return failed(response.error);
  Input input{*request.value, response.value->path, {}, nullptr};
  if (input.path.empty()) return failed(flags.response + ": segments: is empty, there is no path");
  input.corners_C = motion::near_corners_C(input.request.camera);
  if (const auto jump = planning::find_jump(input.path, input.corners_C)) {
    return failed(flags.response + ": " + *jump);
  }
  scene::SnapshotOptions options;
  options.import = flags.scene.import_options();
  const scene::SnapshotResult loaded =
      scene::load_snapshot(flags.scene.file, flags.scene.file, options);
  if (!loaded.snapshot) return failed(loaded.error);
  input.snapshot = loaded.snapshot;
  return {std::move(input), {}};
}

Witness witness_of(const Input& input, const collision::CollisionInterval& interval) {
  const motion::Pose pose = input.path.pose(0.5 * (interval.t_begin_s + interval.t_end_s));
  const auto quad = collision::near_quad_triangles(motion::corners_W(input.corners_C, pose));
  const double anywhere_m = planning::kMaxCoordinate_m;
  const auto nearest = input.snapshot->index.nearest(quad, anywhere_m);
  Witness witness;
  if (!nearest) return witness;
  witness.triangle = nearest->triangle;
  for (const scene::MeshObject& object : input.snapshot->mesh.objects) {
    if (witness.triangle - object.first_triangle < object.triangle_count)
      witness.object = object.name;
  }
  return witness;
}

void print_text(const Input& input, const planning::PathCheck& check) {
  if (check.certificate.certified) {
    fmt::print("free: proved, with a clearance of {:.6g} m or more\n",
               check.certificate.clearance_lower_bound_m);
    return;
  }
  for (const collision::CollisionInterval& interval : check.collisions) {
    const Witness witness = witness_of(input, interval);
    fmt::print("collides from {:.6f} to {:.6f} s with {} (triangle {})\n", interval.t_begin_s,
               interval.t_end_s, witness.object.empty() ? "an unnamed object" : witness.object,
               witness.triangle);
  }
}

void print_json(const Input& input, const planning::PathCheck& check) {
  nlohmann::ordered_json json;
  json["certified"] = check.certificate.certified;
  json["clearance_lower_bound"] = check.certificate.clearance_lower_bound_m;
  json["collisions"] = nlohmann::ordered_json::array();
  for (const collision::CollisionInterval& interval : check.collisions) {
    const Witness witness = witness_of(input, interval);
    json["collisions"].push_back({{"t_begin", interval.t_begin_s},
                                  {"t_end", interval.t_end_s},
                                  {"object", witness.object},
                                  {"triangle", witness.triangle}});
  }
  fmt::print("{}\n", json.dump(2));
}

ExitCode run_check(const CheckFlags& flags) {
  const Parsed<Input> read = read_input(flags);
  if (!read.value) {
    print_error(read.error);
    return ExitCode::kInvalidInput;
  }
  const Input& input = *read.value;
  collision::DetectOptions options;
  options.tolerance_m = input.request.options.interval_tolerance_m;
  options.gap_m = std::max(options.gap_m, options.tolerance_m);
  const auto deadline = collision::Deadline::after_s(input.request.options.deadline_s);
  const planning::PathCheck check = planning::check_path(
      input.snapshot->index, input.path, input.corners_C, options, deadline, deadline);
  if (!check.complete) {
    print_error(fmt::format("{}: the deadline of {} s came first, nothing is known", flags.response,
                            input.request.options.deadline_s));
    return ExitCode::kNegative;
  }
  flags.json ? print_json(input, check) : print_text(input, check);
  return check.certificate.certified ? ExitCode::kSuccess : ExitCode::kNegative;
}

}  // namespace

void add_check_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<CheckFlags>();
  CLI::App* command = app.add_subcommand(
      "check", "Prove a path free of collision, whoever made it, or list where it collides");
  add_scene_flags(*command, flags->scene)->required()->description("Scene file");
  command->add_option("--request", flags->request, "Request file: camera and options")
      ->required()
      ->type_name("FILE");
  command->add_option("--response", flags->response, "Response file: the path, as segments")
      ->required()
      ->type_name("FILE");
  command->add_flag("--json", flags->json, "Write the result as JSON");
  command->footer(exit_code_help("the path collides, or the deadline came first") +
                  "\nExample: camway check --scene office.obj --request R.json --response P.json");
  command->callback([flags, &exit_code] { exit_code = run_check(*flags); });
}

}  // namespace camway::tools
