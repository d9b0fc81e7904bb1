// SPDX-License-Identifier: MIT
#include "tools/camway/common/commands.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <string>

namespace camway::tools {

namespace {

/// Whether a byte begins a control character, of ASCII or of C1 (U+0080 to U+009F) in UTF-8.
bool is_control(std::string_view text, std::size_t at) {
  constexpr unsigned char kFirstPrintable = 0x20;
  constexpr unsigned char kDelete = 0x7F;
  constexpr unsigned char kLeadOfC1 = 0xC2;
  constexpr unsigned char kLastC1 = 0x9F;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (text[at] == '\n' || text[at] == '\t') return false;
  if (byte(at) < kFirstPrintable || byte(at) == kDelete) return true;
  return byte(at) == kLeadOfC1 && at + 1 < text.size() && byte(at + 1) >= 0x80 &&
         byte(at + 1) <= kLastC1;
}

/// Returns a text that changes nothing at a terminal but what it shows.
std::string escaped(std::string_view text) {
  std::string shown;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (!is_control(text, at)) {
      shown += text[at];
      continue;
    }
    // The second byte of a C1 character is its number.
    if (static_cast<unsigned char>(text[at]) >= 0x80) ++at;
    shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at]));
  }
  return shown;
}

}  // namespace

ExitCode worse(ExitCode a, ExitCode b) {
  for (const ExitCode code :
       {ExitCode::kOurFault, ExitCode::kNoDaemon, ExitCode::kInvalidInput, ExitCode::kNegative}) {
    if (a == code || b == code) return code;
  }
  return ExitCode::kSuccess;
}

void print_error(std::string_view message) {
  const std::string line = fmt::format("camway: {}\n", escaped(message));
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
