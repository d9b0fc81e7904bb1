// SPDX-License-Identifier: MIT
#include "tools/camway/common/commands.h"

#include <fmt/format.h>

#include <cstdio>
#include <string>

namespace camway::tools {

ExitCode worse(ExitCode a, ExitCode b) {
  for (const ExitCode code :
       {ExitCode::kOurFault, ExitCode::kNoDaemon, ExitCode::kInvalidInput, ExitCode::kNegative}) {
    if (a == code || b == code) return code;
  }
  return ExitCode::kSuccess;
}

void print_error(std::string_view message) {
  const std::string line = fmt::format("camway: {}\n", message);
  // Not fmt::print, which throws if nothing can be written; that could not be reported anywhere.
  std::fputs(line.c_str(), stderr);
}

std::string exit_code_help(std::string_view negative, bool asks_daemon) {
  return fmt::format("Exit codes: 0 success; 1 our fault{}; 2 invalid input{}{}{}.",
                     asks_daemon ? ", or the daemon's queue stayed full" : "",
                     negative.empty() ? "" : "; 3 ", negative,
                     asks_daemon ? "; 4 no daemon answered" : "");
}

}  // namespace camway::tools
