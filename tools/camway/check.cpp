// SPDX-License-Identifier: MIT
#include "daemon/planning/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/planning/path_faults.h"
#include "daemon/planning/witness.h"
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

/// All that a check needs, read and judged.
struct Input {
  planning::PlanRequest request;
  motion::Path path;
  std::vector<motion::Keyframe> keyframes;  ///< of the request, with times; empty if they have none
  std::optional<motion::Body> body;
  std::shared_ptr<const scene::Snapshot> snapshot;
};

/// Beyond these, a list of missed keyframes is only counted.
constexpr std::size_t kListedMisses = 10;

/// A keyframe is met if the path passes it within what the request calls fine: the motion of a
/// corner to which it wants collisions bracketed.
double met_within_m(const planning::PlanRequest& request) {
  return request.options.interval_tolerance_m;
}

Parsed<Input> failed(std::string error) { return {std::nullopt, std::move(error)}; }

/// The request's keyframes with the times at which they are to be met: its own or, if it leaves
/// them open, those that the response gives, if they increase: wrong ones cannot hide a miss, only
/// make one.
std::vector<motion::Keyframe> timed_keyframes(const planning::PlanRequest& request,
                                              const planning::PlanResult& response) {
  std::vector<motion::Keyframe> keyframes = request.keyframes;
  if (request.has_times) return keyframes;
  std::size_t timed = 0;
  for (const motion::Keyframe& keyframe : response.keyframes) {
    if (keyframe.origin != motion::KeyframeOrigin::kGiven) continue;
    const bool follows = timed == 0 || keyframes[timed - 1].time_s < keyframe.time_s;
    if (timed == keyframes.size() || !follows) return {};
    keyframes[timed++].time_s = keyframe.time_s;
  }
  if (timed < keyframes.size()) return {};
  return keyframes;
}

/// Request and response, each judged by itself.
Parsed<Input> read_files(const CheckFlags& flags) {
  const Parsed<planning::PlanRequest> request = read_plan_request(flags.request);
  if (!request.value) return failed(request.error);
  if (const auto fault = planning::validate(*request.value)) {
    return failed(flags.request + ": " + describe(*fault));
  }
  std::string fault;
  auto body = motion::Body::make(request.value->body.value_or(request.value->camera), fault);
  if (!body) return failed(flags.request + ": body: " + fault);
  const Parsed<planning::PlanResult> response = read_plan_response(flags.response);
  if (!response.value) return failed(response.error);
  return {Input{*request.value, response.value->path,
                timed_keyframes(*request.value, *response.value), std::move(body), nullptr},
          {}};
}

Parsed<Input> read_input(const CheckFlags& flags) {
  Parsed<Input> input = read_files(flags);
  if (!input.value) return input;
  std::optional<std::string> fault = planning::find_fault(input.value->path.segments());
  if (!fault) fault = planning::find_jump(input.value->path, input.value->body->radius_m());
  if (fault) return failed(flags.response + ": " + *fault);
  scene::SnapshotOptions options;
  options.import = flags.scene.import_options();
  const scene::SnapshotResult loaded =
      scene::load_snapshot(flags.scene.file, flags.scene.file, options);
  if (!loaded.snapshot) return failed(loaded.error);
  input.value->snapshot = loaded.snapshot;
  return input;
}

/// What an interval collides with, in words.
std::string culprit(const Input& input, const collision::CollisionInterval& interval) {
  if (!interval.witness) return "what could not be told apart";
  const collision::Witness& witness = *interval.witness;
  const planning::WitnessNames names =
      planning::describe_witness(*input.snapshot->mesh, *input.body, witness);
  return fmt::format("{} (triangle {}) in {}, {:.3g} m deep at {:.6f} s",
                     names.object.empty() ? "an unnamed object" : names.object, witness.triangle,
                     names.feature, witness.depth_m, witness.time_s);
}

nlohmann::ordered_json interval_json(const Input& input,
                                     const collision::CollisionInterval& interval) {
  nlohmann::ordered_json json{{"t_begin", interval.t_begin_s}, {"t_end", interval.t_end_s}};
  if (!interval.witness) return json;
  const collision::Witness& witness = *interval.witness;
  const planning::WitnessNames names =
      planning::describe_witness(*input.snapshot->mesh, *input.body, witness);
  json["witness"] = {{"time", witness.time_s},
                     {"object", names.object},
                     {"triangle", witness.triangle},
                     {"feature", names.feature},
                     {"depth", witness.depth_m},
                     {"point", {witness.point_W.x(), witness.point_W.y(), witness.point_W.z()}}};
  return json;
}

/// Which keyframes the path meets.
struct KeyframeReport {
  std::vector<double> misses_m;  ///< of all; empty if nobody says when they are to be met
  std::vector<std::size_t> missed;
  double largest_miss_m = 0.0;
};

KeyframeReport look_for_keyframes(const Input& input) {
  KeyframeReport report;
  report.misses_m =
      planning::keyframe_misses_m(input.path, input.keyframes, input.body->radius_m());
  for (std::size_t i = 0; i < report.misses_m.size(); ++i) {
    report.largest_miss_m = std::max(report.largest_miss_m, report.misses_m[i]);
    if (report.misses_m[i] > met_within_m(input.request)) report.missed.push_back(i);
  }
  return report;
}

void print_keyframes(const Input& input) {
  const KeyframeReport report = look_for_keyframes(input);
  const std::size_t count = report.misses_m.size();
  if (count == 0) {
    fmt::print("keyframes met: not known, neither request nor response says when\n");
    return;
  }
  fmt::print("keyframes met: {} of {}, largest miss {:.3g} m\n", count - report.missed.size(),
             count, report.largest_miss_m);
  const std::size_t listed = std::min(report.missed.size(), kListedMisses);
  for (const std::size_t i : std::span(report.missed).first(listed)) {
    fmt::print("keyframe {} (at {:.6f} s) is missed by {:.3g} m\n", i, input.keyframes[i].time_s,
               report.misses_m[i]);
  }
  if (listed < report.missed.size()) fmt::print("and {} more\n", report.missed.size() - listed);
}

void print_text(const Input& input, const planning::PathCheck& check) {
  if (check.certificate.certified) {
    fmt::print("free: proved, with a clearance of {:.6g} m or more\n",
               check.certificate.clearance_lower_bound_m);
  }
  for (const collision::CollisionInterval& interval : check.collisions) {
    fmt::print("collides from {:.6f} to {:.6f} s with {}\n", interval.t_begin_s, interval.t_end_s,
               culprit(input, interval));
  }
  print_keyframes(input);
}

nlohmann::ordered_json keyframes_json(const Input& input) {
  const KeyframeReport report = look_for_keyframes(input);
  if (report.misses_m.empty()) return nullptr;
  nlohmann::ordered_json missed = nlohmann::ordered_json::array();
  for (const std::size_t i : report.missed) {
    missed.push_back({{"keyframe", i}, {"miss", report.misses_m[i]}});
  }
  return {{"count", report.misses_m.size()},
          {"met", report.misses_m.size() - report.missed.size()},
          {"largest_miss", report.largest_miss_m},
          {"missed", std::move(missed)}};
}

void print_json(const Input& input, const planning::PathCheck& check) {
  nlohmann::ordered_json json;
  json["certified"] = check.certificate.certified;
  json["clearance_lower_bound"] = check.certificate.clearance_lower_bound_m;
  json["collisions"] = nlohmann::ordered_json::array();
  for (const collision::CollisionInterval& interval : check.collisions) {
    json["collisions"].push_back(interval_json(input, interval));
  }
  json["keyframes"] = keyframes_json(input);
  fmt::print("{}\n", json.dump(2));
}

/// The path and what closes its gaps: a scene that stands in one is a collision at that instant.
planning::PathCheck check_with_bridges(const Input& input) {
  collision::DetectOptions options;
  options.tolerance_m = input.request.options.interval_tolerance_m;
  options.gap_m = std::max(options.gap_m, options.tolerance_m);
  options.clearance_m = input.request.options.clearance_m;
  const auto deadline = collision::Deadline::after_s(input.request.options.deadline_s);
  const auto check_one = [&](const motion::Path& path) {
    return planning::check_path(*input.snapshot, path, *input.body, options, deadline, deadline);
  };
  planning::PathCheck check = check_one(input.path);
  if (!check.certificate.certified) return check;
  for (const planning::Bridge& bridge : planning::bridges(input.path)) {
    const planning::PathCheck gap = check_one(bridge.path);
    check.complete = check.complete && gap.complete;
    if (gap.certificate.certified) {
      double& bound_m = check.certificate.clearance_lower_bound_m;
      bound_m = std::min(bound_m, gap.certificate.clearance_lower_bound_m);
    } else {
      check.certificate = {};
      const auto& witness = gap.collisions.empty() ? std::nullopt : gap.collisions[0].witness;
      check.collisions.push_back({bridge.time_s, bridge.time_s, witness});
    }
  }
  return check;
}

ExitCode run_check(const CheckFlags& flags) {
  const Parsed<Input> read = read_input(flags);
  if (!read.value) {
    print_error(read.error);
    return ExitCode::kInvalidInput;
  }
  const Input& input = *read.value;
  const planning::PathCheck check = check_with_bridges(input);
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
  command->footer(
      "What is proved is freedom of collision, between samples and over joins too. Whether the "
      "path\n"
      "meets the request's keyframes is only measured: a line says how many of them it passes "
      "within\n"
      "options.interval_tolerance_m (0.001 m), at the times of the request or, if it gives none, "
      "of\n"
      "the response. Missed keyframes do not change the exit code. Times, numbers or joins that "
      "make\n"
      "no path are refused as invalid input.\n" +
      exit_code_help("the path collides, or the deadline came first") +
      "\nExample: camway check --scene office.obj --request R.json --response P.json");
  command->callback([flags, &exit_code] { exit_code = run_check(*flags); });
}

}  // namespace camway::tools
