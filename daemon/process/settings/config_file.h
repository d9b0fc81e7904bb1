// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/process/settings/daemon_options.h"

namespace camway::process {

/// Reads the TOML file of `camwayd --config` into `options`: replaces the settings that it names,
/// and adds its scenes. Every relative path in it (scene files, `scenes.roots`, `auth.key_file`) is
/// relative to the folder of the file. Returns a line for each fault: "camwayd.toml:12:
/// 'queue.lenght' is no setting; ..."; with faults, `options` must not be used.
/// `daemon/process/camwayd.toml` documents the file.
std::vector<std::string> read_config_file(const std::filesystem::path& file,
                                          DaemonOptions& options);

}  // namespace camway::process
