// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <vector>

#include "daemon/planning/request/validate.h"
#include "daemon/planning/stages/sentences.h"
#include "tools/answers/check_input.h"
#include "tools/answers/check_report.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/request_file.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

struct CheckFlags {
  SceneFlags scene;
  std::string request;
  std::string response;
  bool json = false;
};

base::Failure failed(std::string error) { return {std::move(error)}; }

/// Reads request and response and checks each on its own.
base::Result<CheckInput> read_files(const CheckFlags& flags,
                                    const base::Result<RequestFile>& request) {
  if (!request) return failed(request.error);
  if (const auto fault = planning::validate(*request)) {
    return failed(source_of(flags.request) + ": " + fault->message);
  }
  const base::Result<PathFile> response = read_as<PathFile>(flags.response);
  if (!response) return failed(response.error);
  return check_input(*request, *response, {source_of(flags.request), source_of(flags.response)});
}

base::Result<CheckInput> read_input(const CheckFlags& flags) {
  const base::Result<RequestFile> request = read_request(flags.request);
  base::Result<CheckInput> input = read_files(flags, request);
  if (!input) return input;
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

ExitCode run_check(const CheckFlags& flags) {
  const base::Result<CheckInput> read = read_input(flags);
  if (!read) {
    print_error(read.error);
    return ExitCode::kInvalidInput;
  }
  const CheckInput& input = *read;
  const PathSearch found =
      search_path(input, base::Deadline::after_s(input.request.options.deadline_s));
  for (const std::string& warning : check_warnings(input, found)) {
    print_error("warning: " + warning);
  }
  if (!found.complete) {
    print_error(fmt::format("{}: {} before the whole path was searched", input.response_file,
                            planning::deadline_text(input.request)));
  }
  fmt::print("{}",
             flags.json ? json_text(check_json(input, found), 2) + "\n" : check_text(input, found));
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
      "bounds, too. Missed keyframes do not change the exit code, nor does a warning\n"
      "that the response's scene_digest is not that of the scene. Times, numbers or joins that "
      "make no\n"
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
