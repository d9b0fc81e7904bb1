// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/process/options.h"

namespace camway::service {

/// Options, or what to say in their place.
struct ParsedOptions {
  std::optional<DaemonOptions> options;
  std::string text;                 ///< after `--help`, `--version` and a good `--check-config`
  std::vector<std::string> faults;  ///< each begins with where it is; the process ends with code 2
};

/// Reads the command line and the configuration file that it names. Another call later sees what
/// became of that file. With `--check-config` it also reads the scenes, as a start would.
ParsedOptions parse_daemon_options(int argc, const char* const* argv);

}  // namespace camway::service
