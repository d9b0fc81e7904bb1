// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "daemon/base/standard_streams.h"
#include "daemon/cli_support/flag_checks.h"
#include "daemon/cli_support/help_tree.h"
#include "daemon/version/build_info.h"
#include "tools/camway/common/commands.h"

namespace {

struct Command {
  std::string_view name;
  void (*add)(CLI::App& app, camway::tools::ExitCode& exit_code);
};

constexpr auto kCommands = std::to_array<Command>({
    {"plan", camway::tools::add_plan_command},
    {"check", camway::tools::add_check_command},
    {"info", camway::tools::add_info_command},
    {"export", camway::tools::add_export_command},
    {"import", camway::tools::add_import_command},
    {"sample", camway::tools::add_sample_command},
    {"occupancy", camway::tools::add_occupancy_command},
    {"load", camway::tools::add_load_command},
    {"replay", camway::tools::add_replay_command},
    {"session", camway::tools::add_session_command},
    {"pack", camway::tools::add_pack_command},
    {"unpack", camway::tools::add_unpack_command},
    {"scene", camway::tools::add_scene_command},
    {"draw", camway::tools::add_draw_command},
    {"cache", camway::tools::add_cache_command},
    {"state", camway::tools::add_state_command},
    {"status", camway::tools::add_status_command},
    {"doctor", camway::tools::add_doctor_command},
    {"watch", camway::tools::add_watch_command},
    {"view", camway::tools::add_view_command},
});

/// Adds the command of that name; all commands if there is none, for the help and for errors. The
/// flags of all commands take longer to declare than many a plan.
void add_commands(CLI::App& app, std::string_view name, camway::tools::ExitCode& exit_code) {
  const auto named = std::ranges::find(kCommands, name, &Command::name);
  for (const Command& command : kCommands) {
    if (named == kCommands.end() || command.name == name) command.add(app, exit_code);
  }
}

int run(int argc, char** argv) {
  using camway::tools::ExitCode;
  ExitCode exit_code = ExitCode::kSuccess;
  CLI::App app("Camway: smooth camera paths through keyframes, corrected until free of collision",
               "camway");
  app.set_version_flag("--version", "camway " + camway::service::version_text());
  app.require_subcommand(1);
  app.footer(
      "Lengths are metres, times seconds, quaternions w, x, y, z. `camway COMMAND --help` says "
      "more.\n" +
      camway::tools::exit_code_help(
          "the answer is no (plan, check, occupancy, load, replay, doctor and watch say of what)",
          /*asks_daemon=*/true));
  add_commands(app, argc > 1 ? argv[1] : "", exit_code);
  if (camway::cli_support::asks_for_help_tree(argc, argv)) {
    std::fputs(camway::cli_support::help_tree(app).c_str(), stdout);
    return 0;
  }
  camway::cli_support::refuse_missing_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help and --version
    // Otherwise `camway scene uplaod --help` would show the help of `camway scene` without an
    // error.
    const std::string unknown = camway::cli_support::unknown_word(app);
    if (unknown.empty()) return app.exit(success);
    camway::tools::print_error(unknown);
    return static_cast<int>(ExitCode::kInvalidInput);
  } catch (const CLI::ParseError& error) {
    camway::tools::print_error(camway::cli_support::command_line_fault(app, error));
    return static_cast<int>(ExitCode::kInvalidInput);
  }
  return static_cast<int>(exit_code);
}

/// Returns whether the output was written completely. fmt::print throws on some failures; most show
/// up only when the stream is flushed here.
bool is_output_written() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

int no_output() {
  camway::tools::print_error(
      "standard output cannot be written: the disk is full, or nobody reads");
  return static_cast<int>(camway::tools::ExitCode::kInvalidInput);
}

}  // namespace

int main(int argc, char** argv) {
  if (!camway::base::occupy_closed_standard_streams()) {
    return static_cast<int>(camway::tools::ExitCode::kOurFault);
  }
  try {
    const int exit_code = run(argc, argv);
    return is_output_written() ? exit_code : no_output();
  } catch (const std::bad_alloc&) {
    camway::tools::print_error("out of memory");
  } catch (const std::exception& error) {
    if (!is_output_written()) return no_output();
    camway::tools::print_error(std::string("internal error: ") + error.what());
  }
  return static_cast<int>(camway::tools::ExitCode::kOurFault);
}
