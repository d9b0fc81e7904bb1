// SPDX-License-Identifier: MIT
#include "daemon/service/daemon_options.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <set>
#include <thread>

#include <CLI/CLI.hpp>

#include "daemon/service/version.h"

namespace camway::service {
namespace {

constexpr char kFooter[] =
    "Exit codes: 0 stopped by SIGTERM or SIGINT once it serves (while it still reads scenes, the "
    "signal ends it at once), 1 LCM cannot be used or failed, 2 wrong command "
    "line or scene file.\n"
    "Example: camwayd --scene office=scenes/office.obj,occupancy=0.1 --scene maze=scenes/maze.obj";

std::string default_url() {
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  const bool set = from_environment != nullptr && *from_environment != '\0';
  return set ? from_environment : kDefaultLcmUrl;
}

int default_workers() {
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 256U));
}

/// What CLI11 fills in, as text where we parse ourselves.
struct Raw {
  std::vector<std::string> scenes;
  std::string log_level = "info";
};

void declare(CLI::App& app, Raw& raw, DaemonOptions& options) {
  app.set_version_flag("--version", std::string("camwayd ") + kVersion + " (" + kBuild + ")");
  app.footer(kFooter);
  app.add_option("--scene", raw.scenes,
                 "A scene to hold; may be given several times. scale: file units to metres; up: "
                 "turns axes; occupancy: edge of a voxel of the occupancy map in metres, no map "
                 "without it")
      ->type_name(kSceneArgumentForm)
      ->required()
      ->take_all();
  app.add_option("--prefix", options.service.prefix, "Channels begin with this")
      ->capture_default_str();
  app.add_option("--url", options.lcm_url,
                 "LCM provider; ttl=0 keeps the traffic on this host [LCM_DEFAULT_URL, else " +
                     std::string(kDefaultLcmUrl) + "]");
  app.add_option("--workers", options.service.workers, "Requests planned at the same time")
      ->default_str("one for each core");
  // CLI11 would read -1 as the largest number there is.
  app.add_option("--queue", options.service.queue.jobs, "Requests that may wait for a worker")
      ->check(CLI::Range(std::size_t{1}, kMaxQueueCapacity))
      ->capture_default_str();
  app.add_option("--client-queue", options.service.queue.jobs_of_a_client,
                 "Requests of one client that may wait for a worker")
      ->check(CLI::Range(std::size_t{1}, kMaxQueueCapacity))
      ->capture_default_str();
  app.add_option("--deadline-s", options.service.deadline.default_s,
                 "Deadline of requests that name none, seconds from their receipt")
      ->capture_default_str();
  app.add_option("--max-deadline-s", options.service.deadline.max_s,
                 "Longest deadline that a request may ask for, seconds")
      ->capture_default_str();
  app.add_option("--log-level", raw.log_level, "What is logged on stderr")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
}

/// Turns the texts into options; returns what is wrong with them.
std::string resolve(const Raw& raw, DaemonOptions& options) {
  std::set<std::string> names;
  for (const std::string& text : raw.scenes) {
    ParsedSceneArgument parsed = parse_scene_argument(text);
    if (!parsed.scene) return "--scene: " + parsed.error;
    if (!names.insert(parsed.scene->name).second) {
      return "--scene: the name '" + parsed.scene->name + "' is given twice";
    }
    options.scenes.push_back(std::move(*parsed.scene));
  }
  options.log_level = spdlog::level::from_str(raw.log_level);
  return options.service.fault();
}

}  // namespace

ParsedOptions parse_daemon_options(int argc, const char* const* argv) {
  DaemonOptions options;
  options.lcm_url = default_url();
  options.service.workers = default_workers();
  Raw raw;
  CLI::App app("camwayd: plans camera paths that are free of collision, over LCM", "camwayd");
  declare(app, raw, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error) == 0 ? 0 : 2};
  }
  if (const std::string error = resolve(raw, options); !error.empty()) {
    std::cerr << "camwayd: " << error << '\n';
    return {std::nullopt, 2};
  }
  return {std::move(options), 0};
}

}  // namespace camway::service
