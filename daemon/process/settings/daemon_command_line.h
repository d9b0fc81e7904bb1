// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/process/settings/daemon_options.h"

namespace camway::process {

/// Options, or the text to print in their place.
struct ParsedOptions {
  std::optional<DaemonOptions> options;
  std::string text;                 ///< after `--help`, `--version` and a good `--check-config`
  std::vector<std::string> faults;  ///< each begins with its place; the process ends with code 2
};

/// Reads the command line and the configuration file that it names. A later call reads the file
/// anew. With `--check-config` also reads the scenes, as a start would.
ParsedOptions parse_daemon_options(int argc, const char* const* argv);

}  // namespace camway::process
