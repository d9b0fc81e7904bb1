// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <string>

#include <CLI/CLI.hpp>

namespace camway::tools {

/// Declares `--key-file` of a command that talks to a daemon.
CLI::Option* add_key_file(CLI::App& command, std::string& file);

/// Makes the clients of these options sign and check by the keys of `file`, unless that is empty.
/// Returns what is wrong with it.
std::string use_key_file(const std::string& file, ClientOptions& options);

}  // namespace camway::tools
