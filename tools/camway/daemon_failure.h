// SPDX-License-Identifier: MIT
#pragma once

#include <camway/status.h>

#include <string>

#include <CLI/CLI.hpp>

#include "tools/camway/commands.h"

namespace camway::tools {

/// Declares `--timeout-s` of a command that asks a daemon.
CLI::Option* add_timeout(CLI::App& command, double& timeout_s);

/// Says on standard error why a daemon gave no answer, or which, with what the flags of a command
/// can do about it; `key_file` is that of `--key-file`, or empty. Returns what the shell is to see.
/// Precondition: `status` is not `kOk`.
ExitCode report_failure(Status status, const std::string& error, const std::string& key_file);

}  // namespace camway::tools
