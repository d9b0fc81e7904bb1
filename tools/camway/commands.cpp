// SPDX-License-Identifier: MIT
#include "tools/camway/commands.h"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>

namespace camway::tools {

ExitCode worse(ExitCode a, ExitCode b) {
  for (const ExitCode code : {ExitCode::kOurFault, ExitCode::kInvalidInput, ExitCode::kNegative}) {
    if (a == code || b == code) return code;
  }
  return ExitCode::kSuccess;
}

void print_error(std::string_view message) { fmt::print(stderr, "camway: {}\n", message); }

std::string write_file(const std::string& file, std::string_view text) {
  std::ofstream out(file, std::ios::binary);
  if (!out) return file + ": cannot be opened for writing";
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  return out ? std::string() : file + ": cannot be written to its end";
}

std::string exit_code_help(std::string_view negative) {
  return fmt::format("Exit codes: 0 success; 1 our fault; 2 invalid input{}{}.",
                     negative.empty() ? "" : "; 3 ", negative);
}

}  // namespace camway::tools
