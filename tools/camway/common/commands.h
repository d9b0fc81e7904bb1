// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace camway::tools {

/// Exit codes of the process, the same for every subcommand.
enum class ExitCode : int {
  kSuccess = 0,
  kOurFault = 1,
  kInvalidInput = 2,
  kNegative = 3,  ///< a negative result; the help of each command defines it
  kNoDaemon = 4,  ///< no daemon was heard, or it did not answer
};

/// Returns the worse of two exit codes. From worst to best: our fault, no daemon, invalid input,
/// negative result, success.
ExitCode worse(ExitCode a, ExitCode b);

/// The next functions each add a subcommand to `app`. The subcommand that the user called runs
/// inside `app.parse` and sets `exit_code`. Require that `exit_code` outlives `app`.
void add_plan_command(CLI::App& app, ExitCode& exit_code);
void add_check_command(CLI::App& app, ExitCode& exit_code);
void add_info_command(CLI::App& app, ExitCode& exit_code);
void add_import_command(CLI::App& app, ExitCode& exit_code);
void add_export_command(CLI::App& app, ExitCode& exit_code);
void add_sample_command(CLI::App& app, ExitCode& exit_code);
void add_occupancy_command(CLI::App& app, ExitCode& exit_code);
void add_load_command(CLI::App& app, ExitCode& exit_code);
void add_replay_command(CLI::App& app, ExitCode& exit_code);
void add_session_command(CLI::App& app, ExitCode& exit_code);
void add_pack_command(CLI::App& app, ExitCode& exit_code);
void add_unpack_command(CLI::App& app, ExitCode& exit_code);
void add_scene_command(CLI::App& app, ExitCode& exit_code);
void add_draw_command(CLI::App& app, ExitCode& exit_code);
void add_cache_command(CLI::App& app, ExitCode& exit_code);
void add_state_command(CLI::App& app, ExitCode& exit_code);
void add_status_command(CLI::App& app, ExitCode& exit_code);
void add_doctor_command(CLI::App& app, ExitCode& exit_code);
void add_watch_command(CLI::App& app, ExitCode& exit_code);
void add_view_command(CLI::App& app, ExitCode& exit_code);

/// Prints `camway: message` on standard error. Control characters, which names and words of files
/// may have and which a terminal obeys, are printed as `\x1b`; line breaks and tabs are kept.
void print_error(std::string_view message);

/// Returns the paragraph on exit codes at the end of a subcommand's help. `negative` defines code
/// 3; if it is empty, code 3 is left out. `asks_daemon`: whether the command asks a daemon, so that
/// code 4 is included.
std::string exit_code_help(std::string_view negative, bool asks_daemon = false);

}  // namespace camway::tools
