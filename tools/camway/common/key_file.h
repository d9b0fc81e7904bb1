// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <string>

#include <CLI/CLI.hpp>

namespace camway::tools {

/// Declares `--key-file` of a command that talks to a daemon.
CLI::Option* add_key_file(CLI::App& command, std::string& file);

/// Makes the clients of these options sign and check messages with the keys of `file`. Does nothing
/// if `file` is empty. Returns the fault of the file; empty on success.
std::string use_key_file(const std::string& file, ClientOptions& options);

}  // namespace camway::tools
