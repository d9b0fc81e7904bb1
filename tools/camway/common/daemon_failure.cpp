// SPDX-License-Identifier: MIT
#include "tools/camway/common/daemon_failure.h"

#include <fmt/format.h>

#include <limits>

#include "daemon/cli_support/flag_checks.h"

namespace camway::tools {
namespace {

/// Returns the exit code of a status. A wrong request or network is invalid input, an answer
/// without the result that was asked for is negative, and a missing answer is neither.
ExitCode exit_code_of(Status status) {
  switch (status) {
    case Status::kInvalid:
    case Status::kUnknownScene:
    case Status::kNoMap:
    case Status::kLimit:
    case Status::kNetworkUnusable:
      return ExitCode::kInvalidInput;
    case Status::kPartial:
    case Status::kInfeasible:
    case Status::kTimeout:
    case Status::kCancelled:
    case Status::kOldScene:
      return ExitCode::kNegative;
    case Status::kNoDaemon:
    case Status::kNoAnswer:
    case Status::kStopping:
      return ExitCode::kNoDaemon;
    default:
      return ExitCode::kOurFault;
  }
}

}  // namespace

CLI::Option* add_timeout(CLI::App& command, std::optional<double>& timeout_s) {
  return command
      .add_option("--timeout-s", timeout_s,
                  fmt::format("How long to wait for the daemon's answer, seconds [{:g}; some 10 "
                              "where no daemon is heard]",
                              ClientOptions{}.deadline_s))
      ->check(cli_support::between(0.01, 86'400.0));
}

void use_timeout(const std::optional<double>& timeout_s, ClientOptions& options) {
  if (!timeout_s) return;
  options.deadline_s = *timeout_s;
  options.retries = std::numeric_limits<int>::max();
}

ExitCode report_failure(Status status, const std::string& error, const std::string& key_file) {
  const ExitCode code = exit_code_of(status);
  std::string hint;
  if (status == Status::kNoDaemon || status == Status::kNoAnswer) {
    hint = key_file.empty() ? " (--key-file names the keys" : " (--key-file " + key_file;
    hint += status == Status::kNoAnswer ? "; --timeout-s says how long to wait)" : ")";
  }
  print_error(error + hint);
  return code;
}

}  // namespace camway::tools
