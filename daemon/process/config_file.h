// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/process/options.h"

namespace camway::service {

/// Reads the TOML file of `camwayd --config` over `options`: what it does not name stays, its
/// scenes are added. Every relative path in it (scene files, `scenes.roots`, `auth.key_file`) is
/// taken relative to its folder. Returns what is wrong, a line for
/// each fault: "camwayd.toml:12: 'queue.lenght' is no setting; ...". `options` are of no use then.
/// `daemon/process/camwayd.toml` documents the file.
std::vector<std::string> read_config_file(const std::filesystem::path& file,
                                          DaemonOptions& options);

}  // namespace camway::service
