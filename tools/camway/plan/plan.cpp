// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "daemon/planning/request/validate.h"
#include "tools/answers/plan_answer.h"
#include "tools/answers/scene_record.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/request_file.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/camway/plan/daemon_plan.h"
#include "tools/camway/plan/option_flags.h"
#include "tools/camway/plan/plan_summary.h"
#include "tools/json/json_request.h"
#include "tools/support/client_response.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

using planning::PlanResult;
using planning::Status;

struct PlanFlags {
  SceneFlags scene;
  std::vector<std::string> requests;
  std::string response;
  std::string response_dir;
  OptionFlags options;
  DaemonFlags daemon;
  bool no_timing = false;
};

/// The answer to a request file; for a failure, an answer with its status.
struct Answer : PlanAnswer {
  std::shared_ptr<const scene::Mesh> mesh;  ///< mesh of the scene; null if it was not loaded
  /// Exit code where a daemon was asked and gave no result, which was said; else nothing.
  std::optional<ExitCode> no_result;
};

/// Those who plan: the loaded scenes of this process, or a daemon.
struct Planners {
  LoadedScenes scenes;
  std::optional<DaemonPlanner> daemon;
};

PlanResult invalid(std::string message) {
  PlanResult result;
  result.status = Status::kInvalid;
  result.message = std::move(message);
  return result;
}

ExitCode exit_code_of(Status status) {
  switch (status) {
    case Status::kOk:
      return ExitCode::kSuccess;
    case Status::kPartial:
    case Status::kInfeasible:
    case Status::kTimeout:
      return ExitCode::kNegative;
    case Status::kInvalid:
    case Status::kUnknownScene:
      return ExitCode::kInvalidInput;
    case Status::kInternalError:
      break;
  }
  return ExitCode::kOurFault;
}

/// Plans a request that is valid in a scene that this process loads.
void answer_here(const PlanFlags& flags, const std::string& file, const RequestFile& request,
                 LoadedScenes& scenes, Answer& answer) {
  answer.scene = flags.scene.file_for(file, request);
  if (answer.scene.empty()) {
    answer.result =
        invalid(source_of(file) + ": scene: is missing, and there is no --scene or --daemon");
    return;
  }
  const scene::ImportOptions reading = flags.scene.import_options(request.reading);
  const LoadedScene& scene = scenes.load(answer.scene, reading);
  if (!scene.result.snapshot) {
    answer.result = invalid(scene.result.error);
    return;
  }
  answer.mesh = scene.result.snapshot->mesh.share();
  answer.scene_reading = reading;
  plan_in_scene(*scene.result.snapshot, request,
                base::Deadline::after_s(request.options.deadline_s), answer);
  answer.result.timing.load_scene_ms = scene.load_ms;
}

/// Has a daemon plan a request that is valid.
void answer_by_daemon(const PlanFlags& flags, const std::string& file, const RequestFile& request,
                      DaemonPlanner& daemon, Answer& answer) {
  answer.scene = flags.daemon.scene;
  answer.request_warnings = request_warnings(request);
  warn_of_reading(source_of(file), request);
  const PlanResponse response = daemon.plan(request);
  if (!has_result(response.status)) {
    answer.no_result = daemon.report(response);
    return;
  }
  answer.scene_digest = response.scene_digest;
  answer.vertical_axis = vertical_axis(std::nullopt, request);
  answer.result = to_plan_result(response);
}

Answer answer_request(const PlanFlags& flags, const std::string& file, Planners& planners) {
  Answer answer;
  base::Result<RequestFile> request = read_request(file);
  if (!request) {
    answer.result = invalid(request.error);
    return answer;
  }
  const std::string source = source_of(file);
  flags.options.apply(*request);
  if (const auto fault = planning::validate(*request)) {
    answer.result = invalid(source + ": " + fault->message);
    answer.result.keyframe = fault->keyframe;
    return answer;
  }
  if (planners.daemon) {
    answer_by_daemon(flags, file, *request, *planners.daemon, answer);
  } else {
    answer_here(flags, file, *request, planners.scenes, answer);
    // The error of a request that could not be begun names its file already.
    if (answer.scene_digest.empty()) return answer;
  }
  if (answer.result.status == Status::kInvalid) {
    answer.result.message = source + ": " + answer.result.message;
  }
  return answer;
}

void print_warnings(const std::string& file, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_error("warning: " + file + ": " + warning);
}

/// Writes the response to `file`, or to standard output if it is empty.
ExitCode write_response(const Answer& answer, const std::string& file, bool no_timing) {
  const base::Result<std::string> text = answer_text(answer, !no_timing);
  if (!text) {
    print_error("the response cannot be written: " + text.error);
    return ExitCode::kOurFault;
  }
  if (file.empty()) {
    const bool written = std::fwrite(text->data(), 1, text->size(), stdout) == text->size() &&
                         std::fflush(stdout) == 0;
    if (written) return ExitCode::kSuccess;
    print_error("standard output cannot be written");
    return ExitCode::kInvalidInput;
  }
  const std::string error = write_file(file, *text);
  if (error.empty()) return ExitCode::kSuccess;
  print_error(error);
  return ExitCode::kInvalidInput;
}

void print_summary(const std::string& request, const Answer& answer) {
  const std::string text = plan_summary(answer.result, answer.mesh.get());
  // The message of an invalid request names the file already.
  print_error(answer.result.status == Status::kInvalid ? text : request + ": " + text);
}

/// Returns why a response could not be written to `file`, or to standard output if it is empty.
std::string why_unwritable_response(const std::string& file,
                                    const std::vector<std::string>& inputs) {
  if (!file.empty()) return why_unwritable(file, inputs);
  const int flags = ::fcntl(STDOUT_FILENO, F_GETFL);
  const bool is_open = flags != -1 && (flags & O_ACCMODE) != O_RDONLY;
  return is_open ? "" : "standard output cannot be written";
}

ExitCode plan_one(const PlanFlags& flags, Planners& planners) {
  const std::string& file = flags.requests.front();
  std::string fault = why_unwritable_response(flags.response, {file, flags.scene.file});
  if (!fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  const Answer answer = answer_request(flags, file, planners);
  if (answer.no_result) return *answer.no_result;
  // The scene that the request names.
  fault = why_unwritable_response(flags.response, {answer.scene});
  if (!fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  print_warnings(answer.scene, answer.scene_warnings);
  print_warnings(source_of(file), answer.request_warnings);
  print_summary(source_of(file), answer);
  const ExitCode outcome = exit_code_of(answer.result.status);
  // Invalid input leaves nothing on standard output, where a path is expected.
  if (outcome == ExitCode::kInvalidInput && flags.response.empty()) return outcome;
  return worse(outcome, write_response(answer, flags.response, flags.no_timing));
}

/// Returns the file of each response. An error if one cannot be written, if two would go to one
/// file, or if one would overwrite a request.
base::Result<std::vector<std::string>> response_files(const PlanFlags& flags) {
  std::vector<std::string> files;
  std::set<std::string> taken;
  for (const std::string& request : flags.requests) {
    const std::filesystem::path name = std::filesystem::path(request).filename();
    const std::string file = (flags.response_dir / name).string();
    if (!taken.insert(file).second)
      return base::Failure{file + ": is the response file of two requests"};
    if (std::string fault = why_unwritable_response(file, flags.requests); !fault.empty())
      return base::Failure{std::move(fault)};
    files.push_back(file);
  }
  return files;
}

/// Prints the head of the table of `--response-dir`.
void print_head() {
  fmt::print("{:<14} {:>9} {:>9} {:>8} {:>9}  {}\n", "status", "ms", "colliding", "inserted",
             "remaining", "request");
}

/// Prints the row of a request, as soon as it is answered.
void print_row(const std::string& request, const PlanResult& result) {
  fmt::print("{:<14} {:>9.1f} {:>9} {:>8} {:>9}  {}\n", planning::to_string(result.status),
             result.timing.total_ms, result.collisions.size(), inserted_count(result),
             result.remaining_collisions.size(), request);
  std::fflush(stdout);
}

ExitCode plan_set(const PlanFlags& flags, Planners& planners) {
  std::error_code error;
  std::filesystem::create_directories(flags.response_dir, error);
  if (error) {
    print_error(flags.response_dir + ": cannot be made: " + error.message());
    return ExitCode::kInvalidInput;
  }
  const base::Result<std::vector<std::string>> files = response_files(flags);
  if (!files) {
    print_error(files.error);
    return ExitCode::kInvalidInput;
  }
  ExitCode outcome = ExitCode::kSuccess;
  std::size_t ok_count = 0;
  std::set<std::string> warned_of;  // once a scene; every response has its own
  print_head();
  for (std::size_t i = 0; i < flags.requests.size(); ++i) {
    const std::string source = source_of(flags.requests[i]);
    const Answer answer = answer_request(flags, flags.requests[i], planners);
    if (answer.no_result) {
      outcome = worse(outcome, *answer.no_result);
      continue;
    }
    if (warned_of.insert(answer.scene).second) {
      print_warnings(answer.scene, answer.scene_warnings);
    }
    print_warnings(source, answer.request_warnings);
    ok_count += answer.result.status == Status::kOk ? 1 : 0;
    print_row(source, answer.result);
    const ExitCode code = exit_code_of(answer.result.status);
    // The table has everything about the others.
    if (code == ExitCode::kInvalidInput || code == ExitCode::kOurFault) {
      print_summary(source, answer);
    }
    outcome = worse(outcome, code);
    outcome = worse(outcome, write_response(answer, (*files)[i], flags.no_timing));
  }
  fmt::print("{} of {} ok\n", ok_count, plural(flags.requests.size(), "request"));
  return outcome;
}

ExitCode run_plan(const PlanFlags& flags) {
  Planners planners{LoadedScenes(flags.scene), {}};
  if (flags.daemon.is_asked()) {
    planners.daemon.emplace(flags.daemon);
    if (!planners.daemon->error().empty()) {
      print_error(planners.daemon->error());
      return ExitCode::kInvalidInput;
    }
  }
  if (!flags.response_dir.empty()) return plan_set(flags, planners);
  if (flags.requests.size() == 1) return plan_one(flags, planners);
  print_error("several requests need --response-dir");
  return ExitCode::kInvalidInput;
}

}  // namespace

void add_plan_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<PlanFlags>();
  CLI::App* command = app.add_subcommand(
      "plan", "Plan a path through the keyframes of a request and write the response");
  add_request_scene_flags(*command, flags->scene);
  CLI::Option* const daemon = add_daemon_flags(*command, flags->daemon);
  for (const char* const flag : {"--scene", "--scale", "--up", "--unknown", "--no-cache"}) {
    command->get_option(flag)->excludes(daemon);
  }
  command->add_option("--request", flags->requests, "Request file, '-' for standard input")
      ->required()
      ->type_name("FILE");
  CLI::Option* response =
      command->add_option("--response", flags->response, "Response file [standard output]")
          ->type_name("FILE");
  command
      ->add_option("--response-dir", flags->response_dir,
                   "Folder for the responses to several requests, named as the requests are; each "
                   "scene is loaded once, a table goes to standard output")
      ->excludes(response)
      ->type_name("DIR");
  flags->options.add_to(*command);
  command->add_flag("--no-timing", flags->no_timing,
                    "Leave timing_ms out, so that two responses compare byte by byte");
  command->footer(
      exit_code_help(
          "no path free of collision was found (partial, infeasible, timeout, cancelled)",
          /*asks_daemon=*/true) +
      "\nWhat must not collide is the request's body: the camera's near quadrilateral, or a box, "
      "sphere, convex or mesh (\"body\": {\"type\": \"box\", \"size\": [x, y, z]}, metres, in the "
      "camera's frame). options.clearance_m asks for a distance to keep; options.orientation and "
      "options.limits say how corrections may turn the camera and how fast it may move; "
      "docs/requests.md explains all options. Fields that are unknown are refused, but for comment "
      "and those that begin with '_'. Each collision of the response has a witness: time, object, "
      "triangle, feature of the body, depth_m, point; corrections say what became of it, and how "
      "hard that was tried where nothing helped. Keyframes that were repaired are marked. To edit "
      "a path, plan the keyframes of its response again, with its frame as the request's frame.\n"
      "A response is written for invalid input too when --response or --response-dir is given.\n"
      "With --daemon a running daemon plans, and the response is the same, except that it has the "
      "name of\nthe daemon's scene, neither scene_reading nor the time of loading it, and the "
      "warnings of its\nimport in its message.\n"
      "Example: camway plan --request scenes/requests/office-graze-door.json --response out.json");
  command->callback([flags, &exit_code] { exit_code = run_plan(*flags); });
}

}  // namespace camway::tools
