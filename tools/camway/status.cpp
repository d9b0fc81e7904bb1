// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "tools/camway/commands.h"

namespace camway::tools {
namespace {

using OrderedJson = nlohmann::ordered_json;

struct StatusFlags {
  ClientOptions client;
  double timeout_s = 3.0;
  bool json = false;
  bool watch = false;
  std::int64_t count = 0;
};

std::string duration_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(seconds);
  constexpr std::int64_t kMinute = 60;
  constexpr std::int64_t kHour = 60 * kMinute;
  constexpr std::int64_t kDay = 24 * kHour;
  if (whole >= kDay) return fmt::format("{} d {} h", whole / kDay, whole % kDay / kHour);
  if (whole >= kHour) return fmt::format("{} h {} min", whole / kHour, whole % kHour / kMinute);
  if (whole >= kMinute) return fmt::format("{} min {} s", whole / kMinute, whole % kMinute);
  return fmt::format("{} s", whole);
}

OrderedJson scene_json(const SceneInfo& scene) {
  return {{"name", scene.name},
          {"revision", scene.revision},
          {"digest", scene.digest},
          {"triangles", scene.num_triangles},
          {"bounds_min_m", scene.bounds_min_m},
          {"bounds_max_m", scene.bounds_max_m},
          {"occupancy_resolution_m", scene.occupancy_resolution_m}};
}

OrderedJson status_json(const DaemonStatus& status) {
  OrderedJson json{{"version", status.version},
                   {"uptime_s", status.uptime_s},
                   {"workers", status.num_workers},
                   {"queued_requests", status.queued_requests},
                   {"running_requests", status.running_requests},
                   {"answered_requests", status.answered_requests},
                   {"repeated_requests", status.repeated_requests},
                   {"overloaded_requests", status.overloaded_requests},
                   {"malformed_messages", status.malformed_messages},
                   {"watched_paths", status.watched_paths},
                   {"broken_paths", status.broken_paths},
                   {"total_scenes", status.total_scenes}};
  json["scenes"] = OrderedJson::array();
  for (const SceneInfo& scene : status.scenes) json["scenes"].push_back(scene_json(scene));
  return json;
}

void print_text(const DaemonStatus& status) {
  fmt::print("camwayd      {}, up {}\n", status.version, duration_text(status.uptime_s));
  fmt::print("workers      {} of {} plan, {} requests wait\n", status.running_requests,
             status.num_workers, status.queued_requests);
  fmt::print(
      "answered     {}, of them {} to requests that were known; {} refused for want of room\n",
      status.answered_requests, status.repeated_requests, status.overloaded_requests);
  fmt::print("malformed    {} messages\n", status.malformed_messages);
  fmt::print("watched      {} paths; {} times one was broken by a change\n", status.watched_paths,
             status.broken_paths);
  fmt::print("scenes       {}\n", status.total_scenes);
  for (const SceneInfo& scene : status.scenes) {
    fmt::print("  {}: revision {}, {} triangles, {}, digest {}\n", scene.name, scene.revision,
               scene.num_triangles,
               scene.occupancy_resolution_m > 0.0
                   ? fmt::format("occupancy at {:g} m", scene.occupancy_resolution_m)
                   : std::string("no occupancy map"),
               scene.digest);
  }
}

/// One line of `--watch`: what changed since the status before it, which may be of a daemon that is
/// gone.
void print_line(const DaemonStatus& status, const std::optional<DaemonStatus>& before) {
  std::string rate = "-";
  if (before && status.uptime_s > before->uptime_s) {
    rate = fmt::format("{:.1f}",
                       static_cast<double>(status.answered_requests - before->answered_requests) /
                           (status.uptime_s - before->uptime_s));
  }
  fmt::print(
      "{:%H:%M:%S} up {:<12} planning {:>3} waiting {:>5} answers/s {:>8} refused {:>6} "
      "malformed {:>6}\n",
      fmt::localtime(std::time(nullptr)), duration_text(status.uptime_s), status.running_requests,
      status.queued_requests, rate, status.overloaded_requests, status.malformed_messages);
}

void print(const StatusFlags& flags, const DaemonStatus& status,
           const std::optional<DaemonStatus>& before) {
  if (flags.json) {
    // A line for each status, so that what reads them knows where one ends.
    fmt::print("{}\n", status_json(status).dump(flags.watch ? -1 : 2, ' ', false,
                                                OrderedJson::error_handler_t::replace));
  } else if (flags.watch) {
    print_line(status, before);
  } else {
    print_text(status);
  }
  std::fflush(stdout);
}

ExitCode run_status(const StatusFlags& flags) {
  Client client(flags.client);
  if (!client.good()) {
    print_error(client.error());
    return ExitCode::kInvalidInput;
  }
  std::optional<DaemonStatus> before;
  for (std::int64_t heard = 0;;) {
    DaemonStatus status = client.status(flags.timeout_s);
    if (!status.ok()) {
      print_error(status.error);
      if (!flags.watch || flags.count > 0) return ExitCode::kNegative;
      continue;
    }
    print(flags, status, before);
    if (!flags.watch || ++heard == flags.count) return ExitCode::kSuccess;
    before = std::move(status);
  }
}

}  // namespace

void add_status_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<StatusFlags>();
  CLI::App* command = app.add_subcommand("status", "Say how a daemon is, by its next heartbeat");
  command->add_option("--url", flags->client.url,
                      "LCM network [LCM_DEFAULT_URL, else multicast on this host]");
  command->add_option("--prefix", flags->client.prefix, "Prefix of the daemon's channels")
      ->capture_default_str();
  command->add_option("--timeout-s", flags->timeout_s, "How long to wait for a heartbeat, seconds")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->add_flag("--json", flags->json,
                    "Print JSON, for machines; with --watch a line for each");
  CLI::Option* watch =
      command->add_flag("--watch", flags->watch, "Go on, with a line for each heartbeat");
  command
      ->add_option("--count", flags->count,
                   "End after so many heartbeats, or the first that "
                   "does not come")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 53))
      ->needs(watch);
  command->footer(exit_code_help("no daemon was heard") + "\nExample: camway status --watch");
  command->callback([flags, &exit_code] { exit_code = run_status(*flags); });
}

}  // namespace camway::tools
