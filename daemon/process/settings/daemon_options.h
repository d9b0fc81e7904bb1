// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/process/metrics/http_page.h"
#include "daemon/process/settings/scene_argument.h"
#include "daemon/record/log_files.h"
#include "daemon/scene/cache/scene_cache.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"
#include "daemon/service/service_config.h"

namespace camway::process {

/// Traffic stays on the host (ttl 0) unless the url says otherwise.
inline constexpr char kDefaultLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0";
/// Returns the value of LCM_DEFAULT_URL; empty if it is not set.
std::string url_of_environment();

/// Authentication of messages.
struct AuthOptions {
  std::string key_file;  ///< empty: messages are neither signed nor checked
  bool required = true;  ///< with keys: whether messages without a signature are dropped
  /// Largest difference between a message's time and ours.
  std::chrono::milliseconds window{30'000};
  std::size_t senders = 16'384;  ///< senders that are remembered at a time
};

/// Where scenes are kept beyond the life of the daemon.
struct StateOptions {
  std::string folder;  ///< empty: nowhere
  std::size_t most_bytes = std::size_t{16} << 30;
};

/// The recording of messages and changes of scenes, for `camway replay`.
struct RecordingOptions {
  std::string folder;  ///< empty: nowhere
  record::RecordLimits limits;
};

/// The part of a daemon in a fleet, which is several processes with the same scenes.
enum class FleetRole : std::uint8_t {
  kAlone,   ///< it is in none
  kFront,   ///< serves clients, and lets planners plan
  kPlanner  ///< plans for fronts; clients do not hear of it
};
inline constexpr std::array<std::string_view, 3> kFleetRoles = {"alone", "front", "planner"};

/// The fleet that a daemon is part of, which NATS joins.
struct FleetOptions {
  FleetRole role = FleetRole::kAlone;
  std::string servers;           ///< URLs of NATS with ',' between them
  std::string name = "camway";   ///< processes of the same name are one fleet
  std::string id;                ///< of this process in it; empty: made of host and process
  std::string credentials_file;  ///< of NATS (`.creds`); empty: none
  std::string ca_file;           ///< PEM, for `tls://`; empty: the system's
  std::string certificate_file;  ///< PEM of this client; empty: none
  std::string key_file;          ///< PEM of its key
  int replicas = 1;              ///< servers that keep each change
  std::size_t jobs = 64;         ///< plans that a front has under way at most
  std::chrono::milliseconds patience{10'000};  ///< for the servers at start, and for changes
};

/// Returns the parts of a list with ',' between them, without blanks around them and empty ones.
std::vector<std::string> servers_of(std::string_view list);

/// The options of `camwayd`: built-in defaults, overridden by the configuration file, overridden by
/// the command line.
struct DaemonOptions {
  std::filesystem::path config_file;  ///< empty: none
  std::vector<SceneArgument> scenes;
  std::vector<std::string> drop_scenes;  ///< `--fleet-drop`: scenes to remove from the fleet
  std::string lcm_url;  ///< `--url`, else the file, else LCM_DEFAULT_URL, else `kDefaultLcmUrl`
  service::LogLevel log_level = service::LogLevel::kInfo;
  service::LogFormat log_format = service::LogFormat::kText;
  bool share_prefix = false;  ///< `--share-prefix`: serve even if another daemon has the prefix
  std::string scene_roots;    ///< folders with ':' between them; see `service::SceneRoots`
  http::Address metrics;      ///< address of the page for Prometheus; port 0: no page
  HttpLimits metrics_limits = {};
  AuthOptions auth;
  std::string cache_folder;  ///< of prepared scenes; empty: the one that the environment names
  std::size_t cache_bytes = std::size_t{2} << 30;  ///< limit of the cache; 0: no cache
  scene::SceneStoreLimits store;
  StateOptions state;
  RecordingOptions record;
  FleetOptions fleet;
  service::ServiceConfig service;
  /// Where each setting was set, by its key: "camwayd.toml:12: queue.requests", "--queue",
  /// "LCM_DEFAULT_URL". Settings with their defaults are not here.
  std::map<std::string, std::string, std::less<>> set_at = {};

  /// Returns where the setting of that key was set, for messages; the key itself if it was not.
  [[nodiscard]] std::string where(std::string_view key) const;
};

/// Returns the cache of prepared scenes that the options ask for; nothing if they ask for none, or
/// neither they nor the environment name a folder.
std::optional<scene::SceneCache> scene_cache(const DaemonOptions& options);

/// Returns the built-in defaults. Their number of workers is 0, which stands for one for each core.
DaemonOptions default_options();

}  // namespace camway::process
