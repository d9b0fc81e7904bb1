// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "tools/camway/common/commands.h"

namespace camway::tools {

/// Declares `--timeout-s` of a command that asks a daemon.
CLI::Option* add_timeout(CLI::App& command, std::optional<double>& timeout_s);

/// Makes a client wait so long, though it hear no daemon: one may be about to start. Without a
/// timeout it stays as it is, and gives up earlier where it hears none.
void use_timeout(const std::optional<double>& timeout_s, ClientOptions& options);

/// Says on standard error why a daemon gave no answer, or which, with what the flags of a command
/// can do about it; `key_file` is that of `--key-file`, or empty. Returns what the shell is to see.
/// Precondition: `status` is not `kOk`.
ExitCode report_failure(Status status, const std::string& error, const std::string& key_file);

}  // namespace camway::tools
