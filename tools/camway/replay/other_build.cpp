// SPDX-License-Identifier: MIT
#include "tools/camway/replay/other_build.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "daemon/messages/text.h"
#include "tools/camway/replay/replay_flags.h"
#include "tools/json/json_response.h"
#include "tools/support/scratch_folder.h"

namespace camway::tools {
namespace {

RecordedAnswer answer_of(const planning::PlanResult& result, std::string scene_digest) {
  RecordedAnswer answer;
  answer.result = messages::to_wire(result, {});
  answer.status = messages::status_name(answer.result->status);
  answer.scene_digest = std::move(scene_digest);
  return answer;
}

/// Returns the files of a folder of responses, by client and id as their names have them.
std::map<std::string, std::filesystem::path> responses_in(const std::string& folder) {
  std::map<std::string, std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().stem().string();
    const std::size_t number_end = name.find_first_not_of("0123456789");
    if (number_end == std::string::npos || name[number_end] != '_') continue;
    files.emplace(name.substr(number_end + 1), entry.path());
  }
  return files;
}

std::vector<std::string> command_of(const ReplayFlags& flags, std::int64_t begin_utime,
                                    const std::string& responses) {
  std::vector<std::string> command{
      flags.baseline_build,    "replay",    flags.log,
      "--responses",           responses,   "--prefix",
      flags.publishing.prefix, "--threads", std::to_string(flags.run.threads)};
  const auto add = [&](const std::string& flag, const std::vector<std::string>& values) {
    for (const std::string& value : values) command.insert(command.end(), {flag, value});
  };
  add("--scene", flags.sources.scenes);
  add("--root", flags.sources.roots);
  if (!flags.key_file.empty()) add("--key-file", {flags.key_file});
  std::ranges::move(words_of(flags.selection, begin_utime), std::back_inserter(command));
  // The answers of both builds are cut short by the same deadlines.
  if (flags.run.least_deadline_s > 0.0) {
    add("--least-deadline-s", {fmt::format("{}", flags.run.least_deadline_s)});
  }
  return command;
}

/// Has the other build replay the log. Returns why that failed; empty on success.
std::string take_answers_of_build(const ReplayFlags& flags, std::int64_t begin_utime,
                                  std::vector<RecordedRequest>& requests) {
  const base::Result<ScratchFolder> folder = ScratchFolder::make("replay");
  if (!folder) return folder.error;
  const std::string responses = (folder->path() / "responses").string();
  const std::string output = (folder->path() / "output").string();
  const base::Result<int> code = run_program(command_of(flags, begin_utime, responses), output);
  if (!code) return flags.baseline_build + ": " + code.error;
  // Its verdict does not matter: it is about the log.
  if (!responses_in(responses).empty()) return take_responses(responses, requests);
  const base::Result<std::string> said = read_text(output);
  return fmt::format("{}: ended with {} and wrote no responses: {}", flags.baseline_build, *code,
                     said ? *said : said.error);
}

}  // namespace

base::Result<RecordedAnswer> answer_through_file(const ReplayedRequest& replayed) {
  const base::Result<std::string> text = write_plan_response(replayed.result);
  if (!text) return base::Failure{text.error};
  const auto read = parse_as<planning::PlanResult>(*text, "response");
  if (!read) return base::Failure{read.error};
  return answer_of(*read, replayed.compared.now->scene_digest);
}

std::string take_responses(const std::string& folder, std::vector<RecordedRequest>& requests) {
  const auto files = responses_in(folder);
  for (RecordedRequest& request : requests) {
    request.answer.reset();
    const auto found =
        files.find(fmt::format("{}_{}", request.ids.client_id, request.ids.request_id));
    if (found == files.end()) continue;
    auto read = read_as<ResponseFile>(found->second.string());
    if (!read) return read.error;
    request.answer = answer_of(*read, read->scene_digest);
  }
  return {};
}

base::Result<int> run_program(const std::vector<std::string>& command,
                              const std::string& output_file) {
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_file.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int error =
      ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return base::Failure{std::string("cannot be run: ") + std::strerror(error)};
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return base::Failure{std::string("is lost: ") + std::strerror(errno)};
  }
  if (!WIFEXITED(status)) return base::Failure{fmt::format("ended by signal {}", WTERMSIG(status))};
  return WEXITSTATUS(status);
}

ExitCode compare_builds(const ReplayFlags& flags, const wire::MessageKeys* keys) {
  const std::optional<OpenedSession> opened = open_session(flags.log, flags, keys);
  if (!opened) return ExitCode::kInvalidInput;
  const Session& session = opened->session;
  if (const std::string fault = why_unwritable(flags.reports, flags.inputs()); !fault.empty()) {
    return invalid_replay(fault);
  }
  const std::unique_ptr<ReplayScenes> scenes = open_needed_scenes(*opened, flags, keys);
  if (!scenes) return ExitCode::kInvalidInput;
  // The requests with the answers of the other build.
  std::vector<RecordedRequest> requests = session.requests;
  std::string fault = take_answers_of_build(flags, session.begin_utime, requests);
  if (!fault.empty()) return invalid_replay(fault);
  std::vector<ComparedRequest> compared;
  const std::vector<ReplayedRequest> replayed = replay(session, *scenes, flags.run);
  for (std::size_t i = 0; i < replayed.size(); ++i) {
    ComparedRequest& item = compared.emplace_back();
    item.recorded = &requests[i];
    if (!replayed[i].compared.now) {
      item.note = replayed[i].compared.note;
      item.scene_is_damaged = replayed[i].compared.scene_is_damaged;
      continue;
    }
    base::Result<RecordedAnswer> answer = answer_through_file(replayed[i]);
    if (!answer) return invalid_replay(answer.error);
    item.now = std::move(*answer.value);
    static_cast<Judgement&>(item) = judge(requests[i], answers_of(item), flags.run.thresholds);
    name_remedy(item);
  }
  ReportHead head{
      .title = flags.log, .then = "the other build", .now = "this build", .times = flags.times()};
  head.notes = notes_about(session);
  head.thresholds = flags.run.thresholds;
  fault = write_reports(head, compared, scene_of(*scenes), flags.reports);
  const ExitCode code = code_of(compared, flags.failing, session.is_damaged());
  return fault.empty() ? code : worse(code, invalid_replay(fault));
}

}  // namespace camway::tools
