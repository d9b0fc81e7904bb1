// SPDX-License-Identifier: MIT
#pragma once

#include <spdlog/common.h>

#include <optional>
#include <string>
#include <vector>

#include "daemon/scene/scene_store.h"
#include "daemon/service/config.h"
#include "daemon/service/scene_argument.h"

namespace camway::service {

/// Traffic stays on the host (ttl 0) unless the url says otherwise.
inline constexpr char kDefaultLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0";

/// The command line of `camwayd`.
struct DaemonOptions {
  std::vector<SceneArgument> scenes;
  std::string lcm_url;  ///< `--url`, else LCM_DEFAULT_URL, else `kDefaultLcmUrl`
  spdlog::level::level_enum log_level = spdlog::level::info;
  scene::SceneStoreLimits store;
  ServiceConfig service;
};

/// Options, or the code to exit with: 0 after `--help` and `--version`, 2 after an error. What
/// there was to say has been printed then.
struct ParsedOptions {
  std::optional<DaemonOptions> options;
  int exit_code = 0;
};

ParsedOptions parse_daemon_options(int argc, const char* const* argv);

}  // namespace camway::service
