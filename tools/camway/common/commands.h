// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace camway::tools {

/// What the shell sees. The same numbers for every subcommand.
enum class ExitCode : int {
  kSuccess = 0,
  kOurFault = 1,
  kInvalidInput = 2,
  kNegative = 3,  ///< the answer is no; what that means each command's help says
  kNoDaemon = 4,  ///< no daemon was heard, or it did not answer
};

/// The worse of two outcomes of a set: our fault before no daemon, invalid input and a
/// negative answer, in this order.
ExitCode worse(ExitCode a, ExitCode b);

/// Each adds its subcommand to `app`. When it is the one that was called it runs inside `app.parse`
/// and leaves its outcome in `exit_code`, which must outlive `app`.
void add_plan_command(CLI::App& app, ExitCode& exit_code);
void add_check_command(CLI::App& app, ExitCode& exit_code);
void add_info_command(CLI::App& app, ExitCode& exit_code);
void add_occupancy_command(CLI::App& app, ExitCode& exit_code);
void add_load_command(CLI::App& app, ExitCode& exit_code);
void add_replay_command(CLI::App& app, ExitCode& exit_code);
void add_scene_command(CLI::App& app, ExitCode& exit_code);
void add_draw_command(CLI::App& app, ExitCode& exit_code);
void add_status_command(CLI::App& app, ExitCode& exit_code);
void add_doctor_command(CLI::App& app, ExitCode& exit_code);
void add_watch_command(CLI::App& app, ExitCode& exit_code);

/// `camway: message` on standard error.
void print_error(std::string_view message);

/// The paragraph on exit codes that ends the help of every subcommand. `negative` says what 3
/// means; empty: it does not occur. 4 does where a daemon is asked.
std::string exit_code_help(std::string_view negative, bool asks_daemon = false);

}  // namespace camway::tools
