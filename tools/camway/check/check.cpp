// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "daemon/planning/result/path_faults.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/planning/stages/sentences.h"
#include "tools/camway/check/check_report.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/request_file.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"

namespace camway::tools {
namespace {

struct CheckFlags {
  SceneFlags scene;
  std::string request;
  std::string response;
  bool json = false;
};

base::Failure failed(std::string error) { return {std::move(error)}; }

/// Returns the request's keyframes with their times: those of the request, or those of the response
/// if the request has none or the path was slowed. Returns nothing if the times of the response do
/// not increase. Wrong times cannot hide a missed keyframe, only cause one.
std::vector<motion::Keyframe> timed_keyframes(const planning::PlanRequest& request,
                                              const PathFile& response) {
  std::vector<motion::Keyframe> keyframes = request.keyframes;
  if (request.has_times && response.time_scale == 1.0) return keyframes;
  std::size_t count = 0;
  double before_s = -std::numeric_limits<double>::infinity();
  for (const motion::Keyframe& passed : response.keyframes) {
    if (passed.origin == motion::KeyframeOrigin::kInserted) continue;
    if (count == keyframes.size() || !(before_s < passed.time_s)) return {};
    before_s = passed.time_s;
    keyframes[count++].time_s = before_s;
  }
  if (count < keyframes.size()) keyframes.clear();
  return keyframes;
}

/// Reads request and response and checks each on its own.
base::Result<CheckInput> read_files(const CheckFlags& flags,
                                    const base::Result<RequestFile>& request) {
  if (!request) return failed(request.error);
  if (const auto fault = planning::validate(*request)) {
    return failed(source_of(flags.request) + ": " + fault->message);
  }
  const base::Result<PathFile> response = read_as<PathFile>(flags.response);
  if (!response) return failed(response.error);
  auto body = motion::Body::make(planning::body_shape(*request, response->near_scale));
  if (!body) return failed(source_of(flags.request) + ": body: " + body.error);
  // Only the response has the bounds of the scene that it was planned in.
  const geometry::Bounds bounds = request->options.bounds.within(response->bounds);
  return CheckInput{*request,
                    response->path,
                    source_of(flags.response),
                    timed_keyframes(*request, *response),
                    *std::move(body),
                    nullptr,
                    response->scene_digest,
                    response->near_scale,
                    bounds};
}

base::Result<CheckInput> read_input(const CheckFlags& flags) {
  const base::Result<RequestFile> request = read_request(flags.request);
  base::Result<CheckInput> input = read_files(flags, request);
  if (!input) return input;
  std::optional<std::string> fault = planning::find_fault(input->path.segments());
  if (!fault) fault = planning::find_jump(input->path, input->body->radius_m());
  if (fault) return failed(source_of(flags.response) + ": " + *fault);
  const std::string scene_file = flags.scene.file_for(flags.request, *request);
  if (scene_file.empty()) {
    return failed(source_of(flags.request) + ": scene: is missing, and there is no --scene");
  }
  scene::SnapshotOptions options;
  options.import = flags.scene.import_options(request->reading);
  const scene::SnapshotResult loaded =
      load_timed(scene_file, scene_file, options, user_cache(flags.scene)).result;
  if (!loaded.snapshot) return failed(loaded.error);
  input->snapshot = loaded.snapshot;
  return input;
}

PathSearch search(const CheckInput& input) {
  return search_path({collision::Obstacles(*input.snapshot).within(input.bounds), *input.body,
                      planning::detect_options(input.request.options)},
                     input.path, base::Deadline::after_s(input.request.options.deadline_s));
}

ExitCode run_check(const CheckFlags& flags) {
  const base::Result<CheckInput> read = read_input(flags);
  if (!read) {
    print_error(read.error);
    return ExitCode::kInvalidInput;
  }
  const CheckInput& input = *read;
  const PathSearch found = search(input);
  for (const std::string& warning : check_warnings(input, found)) {
    print_error("warning: " + warning);
  }
  if (!found.complete) {
    print_error(fmt::format("{}: {} before the whole path was searched", input.response_file,
                            planning::deadline_reached(input.request)));
  }
  fmt::print("{}", flags.json ? check_json(input, found).dump(2) + "\n" : check_text(input, found));
  return found.certificate.certified ? ExitCode::kSuccess : ExitCode::kNegative;
}

}  // namespace

void add_check_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<CheckFlags>();
  CLI::App* command = app.add_subcommand(
      "check", "Prove a path free of collision, whoever made it, or list where it collides");
  add_request_scene_flags(*command, flags->scene);
  command->add_option("--request", flags->request, "Request file: scene, camera and options")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--response", flags->response,
                   "Response file, or any with the path as \"segments\"")
      ->required()
      ->type_name("FILE");
  command->add_flag("--json", flags->json, "Write the result as JSON");
  command->footer(
      "What is proved is freedom of collision, between samples and over joins too. Where the "
      "deadline\n"
      "(options.deadline_s) comes first, what was found is listed, and how far the search came.\n"
      "Whether the path meets the request's keyframes is only measured: a line says how many of "
      "them\n"
      "it passes within options.interval_tolerance_m (0.001 m), at the times of the request or, if "
      "it\n"
      "gives none, of the response. The body must stay within options.bounds and the response's\n"
      "bounds, too. Missed keyframes do not change the exit code, nor does a "
      "warning\n"
      "that the response's scene_digest is not that of the scene. Times, numbers or joins that "
      "make "
      "no\n"
      "path are refused as invalid input, and so are unknown fields of segments, but for comment "
      "and\n"
      "those that begin with '_'. Of the rest of the response only keyframes[].time, "
      "keyframes[].origin,\n"
      "bounds and scene_digest are read, if they are there.\n" +
      exit_code_help("the path collides, or the deadline came first") +
      "\nExample: camway check --request "
      "scenes/requests/office-graze-door.json --response out.json");
  command->callback([flags, &exit_code] { exit_code = run_check(*flags); });
}

}  // namespace camway::tools
