// SPDX-License-Identifier: MIT
#include "tools/camway/replay/step.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <utility>

#include "tools/camway/replay/replay_flags.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

enum class StepOrder { kNext, kDraw, kQuit, kUnknown };

StepOrder read_order(std::istream& in) {
  std::string line;
  if (!std::getline(in, line) || line == "q") return StepOrder::kQuit;
  if (line.empty() || line == "n") return StepOrder::kNext;
  return line == "d" ? StepOrder::kDraw : StepOrder::kUnknown;
}

void draw_step(const ComparedRequest& compared, ReplayScenes& scenes, const StepDesk& desk) {
  const messages::RequestIds& ids = compared.recorded->ids;
  const std::string file = fmt::format("replay_{}_{}.svg", ids.client_id, ids.request_id);
  const std::string svg = picture_of(compared, scene_of(scenes), {});
  const std::string fault =
      svg.empty() ? "there is no path to draw" : desk.write_picture(file, svg);
  desk.out << (fault.empty() ? "wrote " + file : fault) << '\n';
}

/// Asks until the person goes on. Returns false to stop.
bool ask_to_go_on(const ComparedRequest& compared, ReplayScenes& scenes, const StepDesk& desk) {
  for (;;) {
    desk.out << "Enter: next, d: draw, q: quit > " << std::flush;
    switch (read_order(desk.in)) {
      case StepOrder::kNext:
        return true;
      case StepOrder::kQuit:
        return false;
      case StepOrder::kDraw:
        draw_step(compared, scenes, desk);
        break;
      case StepOrder::kUnknown:
        desk.out << "type Enter, d or q\n";
    }
  }
}

void show_step(std::size_t number, std::size_t of, const ReplayedRequest& replayed,
               std::ostream& out) {
  out << fmt::format("{} of {}, {:.3f} s\n", number, of, replayed.compared.recorded->received_s)
      << text_row(row_of(replayed.compared), Times::kShown)
      << fmt::format("  {}: {}\n", planning::to_string(replayed.result.status),
                     replayed.result.message);
}

}  // namespace

std::vector<ComparedRequest> step_through(const Session& session, ReplayScenes& scenes,
                                          const ReplayOptions& options, const StepDesk& desk) {
  std::vector<ComparedRequest> seen;
  for (const RecordedRequest& recorded : session.requests) {
    ReplayedRequest replayed = replay_one(recorded, scenes, options);
    show_step(seen.size() + 1, session.requests.size(), replayed, desk.out);
    seen.push_back(std::move(replayed.compared));
    const bool is_last = seen.size() == session.requests.size();
    if (!ask_to_go_on(seen.back(), scenes, desk) || is_last) break;
  }
  desk.out << summary_line(seen) << '\n';
  return seen;
}

ExitCode replay_by_steps(const ReplayFlags& flags, const wire::MessageKeys* keys) {
  if (::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0) {
    return invalid_replay("--step: asks after each request, which needs a terminal");
  }
  const std::optional<OpenedSession> opened = open_session(flags.log, flags, keys);
  if (!opened) return ExitCode::kInvalidInput;
  const Session& session = opened->session;
  const std::unique_ptr<ReplayScenes> scenes = open_needed_scenes(*opened, flags, keys);
  if (!scenes) return ExitCode::kInvalidInput;
  const StepDesk desk{std::cin, std::cout, [](const std::string& file, const std::string& svg) {
                        return write_file(file, svg);
                      }};
  const auto seen = step_through(session, *scenes, flags.run, desk);
  return code_of(seen, flags.failing, session.is_damaged());
}

}  // namespace camway::tools
