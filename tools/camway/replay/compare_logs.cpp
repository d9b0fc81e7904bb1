// SPDX-License-Identifier: MIT
#include <iterator>

#include "tools/camway/replay/replay_flags.h"

namespace camway::tools {

ExitCode compare_logs(const ReplayFlags& flags, const wire::MessageKeys* keys) {
  const std::optional<OpenedSession> then = open_session(flags.baseline, flags, keys);
  std::optional<OpenedSession> now = open_session(flags.against, flags, keys);
  if (!then || !now) return ExitCode::kInvalidInput;
  if (const std::string fault = why_unwritable(flags.reports, flags.inputs()); !fault.empty()) {
    return invalid_replay(fault);
  }
  // Only pictures show scenes.
  const std::unique_ptr<ReplayScenes> scenes = open_scenes(*then, flags, keys);
  if (!scenes) return ExitCode::kInvalidInput;
  ReportHead head{.title = flags.baseline + " and " + flags.against,
                  .then = "baseline",
                  .times = flags.times()};
  head.notes = notes_about(then->session, flags.baseline + ": ");
  std::ranges::move(notes_about(now->session, flags.against + ": "),
                    std::back_inserter(head.notes));
  head.thresholds = flags.run.thresholds;
  const bool is_damaged = then->session.is_damaged() || now->session.is_damaged();
  const auto compared = compare(then->session, now->session, flags.run.thresholds);
  const std::string fault = write_reports(head, compared, scene_of(*scenes), flags.reports);
  const ExitCode code = code_of(compared, flags.failing, is_damaged);
  return fault.empty() ? code : worse(code, invalid_replay(fault));
}

}  // namespace camway::tools
