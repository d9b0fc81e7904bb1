// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "tools/camway/common/commands.h"

namespace camway::tools {

/// Declares `--timeout-s` of a command that talks to a daemon.
CLI::Option* add_timeout(CLI::App& command, std::optional<double>& timeout_s);

/// If `timeout_s` is set, makes a client wait that long even if it hears no daemon, because a
/// daemon may be starting. Otherwise does not change `options`: the client then gives up early if
/// it hears no daemon.
void use_timeout(const std::optional<double>& timeout_s, ClientOptions& options);

/// Prints a failure of the daemon on standard error, with the flags that may help. `key_file` is
/// that of `--key-file`, or empty. Returns the exit code. Requires a `status` other than `kOk`.
ExitCode report_failure(Status status, const std::string& error, const std::string& key_file);

}  // namespace camway::tools
