// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "tools/camway/replay/replay_flags.h"
#include "tools/json/json_response.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

/// Makes the folder for responses. Returns an error text if no file can be written there.
std::string make_responses_dir(const std::string& folder) {
  if (folder.empty()) return {};
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return folder + ": cannot be made: " + error.message();
  return why_unwritable(std::filesystem::path(folder) / "response.json", {});
}

/// Writes the response to each request as a file. Returns an error text, empty on success. Client
/// ids consist of letters, digits, '-' and '_', so they are valid file names.
std::string write_responses(const ReplayFlags& flags,
                            const std::vector<ReplayedRequest>& replayed) {
  for (std::size_t i = 0; i < replayed.size(); ++i) {
    const RecordedRequest& recorded = *replayed[i].compared.recorded;
    ResponseFormat format;
    format.has_timing = !flags.no_timing;
    format.scene = recorded.scene;
    if (replayed[i].compared.now) format.scene_digest = replayed[i].compared.now->scene_digest;
    const base::Result<std::string> text = write_plan_response(replayed[i].result, format);
    if (!text) return "the response cannot be written: " + text.error;
    const std::string name =
        fmt::format("{:04}_{}_{}.json", i, recorded.ids.client_id, recorded.ids.request_id);
    const auto file = std::filesystem::path(flags.responses_dir) / name;
    if (std::string fault = write_file(file, *text); !fault.empty()) return fault;
  }
  return {};
}

}  // namespace

ExitCode replay_offline(const ReplayFlags& flags, const wire::MessageKeys* keys) {
  const std::optional<OpenedSession> opened = open_session(flags.log, flags, keys);
  if (!opened) return ExitCode::kInvalidInput;
  const Session& session = opened->session;
  std::string fault = make_responses_dir(flags.responses_dir);
  if (fault.empty()) fault = why_unwritable(flags.reports, flags.inputs());
  if (!fault.empty()) return invalid_replay(fault);
  const std::unique_ptr<ReplayScenes> scenes = open_needed_scenes(*opened, flags, keys);
  if (!scenes) return ExitCode::kInvalidInput;
  std::vector<ReplayedRequest> replayed = replay(session, *scenes, flags.run);
  if (!flags.responses_dir.empty()) fault = write_responses(flags, replayed);
  std::vector<ComparedRequest> compared;
  for (ReplayedRequest& each : replayed) compared.push_back(std::move(each.compared));
  ReportHead head{.title = flags.log, .times = flags.times()};
  head.notes = notes_about(session);
  head.thresholds = flags.run.thresholds;
  const std::string unwritten = write_reports(head, compared, scene_of(*scenes), flags.reports);
  if (fault.empty()) fault = unwritten;
  const ExitCode code = code_of(compared, flags.failing, session.is_damaged());
  return fault.empty() ? code : worse(code, invalid_replay(fault));
}

}  // namespace camway::tools
