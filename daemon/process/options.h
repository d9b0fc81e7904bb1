// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/process/http_page.h"
#include "daemon/process/scene_argument.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"
#include "daemon/service/service_config.h"

namespace camway::service {

/// Traffic stays on the host (ttl 0) unless the url says otherwise.
inline constexpr char kDefaultLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0";
/// What the environment's LCM_DEFAULT_URL says; empty if it says nothing.
std::string url_of_environment();

/// Whose messages are listened to.
struct AuthOptions {
  std::string key_file;  ///< empty: messages are neither signed nor checked
  bool required = true;  ///< with keys: whether messages without a signature are dropped
  std::chrono::milliseconds window{30'000};  ///< how far a message's time may be from ours
  std::size_t senders = 16'384;              ///< whose messages are told apart at a time
};

/// What `camwayd` is to do: built-in defaults, the configuration file over them, the command line
/// over both.
struct DaemonOptions {
  std::filesystem::path config_file;  ///< empty: none
  std::vector<SceneArgument> scenes;
  std::string lcm_url;  ///< `--url`, else the file, else LCM_DEFAULT_URL, else `kDefaultLcmUrl`
  LogLevel log_level = LogLevel::kInfo;
  LogFormat log_format = LogFormat::kText;
  bool share_prefix = false;  ///< `--share-prefix`: serve though another daemon has the prefix
  std::string scene_roots;  ///< folders with ':' between them; see `SceneRoots`
  HttpAddress metrics;      ///< of the page for Prometheus; there is none if the port is 0
  HttpLimits metrics_limits = {};
  AuthOptions auth;
  scene::SceneStoreLimits store;
  ServiceConfig service;
  /// By the key of the setting, where it was said: "camwayd.toml:12: queue.requests", "--queue",
  /// "LCM_DEFAULT_URL". Settings that have their defaults are not here.
  std::map<std::string, std::string, std::less<>> said_at = {};

  /// Where the setting of that key was said, for messages; else the key.
  [[nodiscard]] std::string where(std::string_view key) const;
};

/// What holds where neither file nor command line says anything: 0 workers, which stands for one
/// for each core.
DaemonOptions default_options();

}  // namespace camway::service
