// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "daemon/cli_support/flag_checks.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/daemon_failure.h"
#include "tools/camway/common/key_file.h"
#include "tools/camway/plan/plan_summary.h"
#include "tools/camway/scene/scene_text.h"
#include "tools/json/json_text.h"
#include "tools/view/daemon/status_json.h"

namespace camway::tools {
namespace {

using OrderedJson = nlohmann::ordered_json;
using view::status_json;

struct StatusFlags {
  ClientOptions client;
  std::string key_file;
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

/// The quantiles that are shown, and their names.
constexpr std::array<std::pair<const char*, double>, 3> kQuantiles{
    {{"p50", 0.5}, {"p99", 0.99}, {"p999", 0.999}}};
constexpr double kMillisecondsPerSecond = 1e3;

/// "ok 12, partial 3"
std::string answers_text(const std::array<std::int64_t, 16>& answers) {
  std::string text;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (answers.at(i) == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", to_string(static_cast<Status>(i)),
                        answers.at(i));
  }
  return text.empty() ? "none" : text;
}

/// "p50 1.2 ms, p99 3.4 ms, p999 5.6 ms"
std::string quantiles_text(const Latency& latency) {
  std::string text;
  for (const auto& [name, q] : kQuantiles) {
    text += fmt::format("{}{} {:.3g} ms", text.empty() ? "" : ", ", name,
                        latency.quantile_s(q) * kMillisecondsPerSecond);
  }
  return latency.count > 0 ? text : "-";
}

double per_second(std::int64_t count, double seconds) {
  return seconds > 0.0 ? static_cast<double>(count) / seconds : 0.0;
}

void print_traffic(const DaemonStatus& status) {
  fmt::print("messages     {} in ({} bytes), {} out ({} bytes), {} not sent\n",
             status.received_messages, status.received_bytes, status.sent_messages,
             status.sent_bytes, status.unsent_messages);
  fmt::print(
      "lost         {} pages of requests and {} of answers were asked for again, {} answers "
      "found no room\n",
      status.request_pages_asked_again, status.answer_pages_asked_again, status.dropped_answers);
  fmt::print("malformed    {} messages\n", status.malformed_messages);
  fmt::print(
      "distrusted   {} unsigned{}, {} broken, {} of unknown keys, {} of a wrong key or altered, {} "
      "stale, {} replayed, {} of too many senders\n",
      status.unsigned_messages, status.signed_only ? " (all are dropped)" : "",
      status.broken_envelopes, status.unknown_key_messages, status.altered_messages,
      status.stale_messages, status.replayed_messages, status.crowded_messages);
}

/// Returns the line about reloads if one failed.
void print_reloads(const DaemonStatus& status) {
  if (status.failed_reloads == 0) return;
  constexpr std::int64_t kMicroseconds = 1'000'000;
  constexpr std::int64_t kYear10000_s = 253'402'300'800;  // no calendar goes on for ever
  const std::int64_t time_s =
      std::clamp(status.failed_reload_utime / kMicroseconds, std::int64_t{0}, kYear10000_s);
  fmt::print(
      "reload       {} at {:%Y-%m-%d %H:%M:%S}{}: {}\n",
      status.reload_failed ? "FAILED" : "one failed",
      fmt::localtime(static_cast<std::time_t>(time_s)),
      status.reload_failed ? ", the daemon serves what it had before" : ", a later one was done",
      status.failed_reload);
}

/// Returns the line about the recording, if the daemon records.
void print_recording(const DaemonStatus& status) {
  if (status.recording_folder.empty()) return;
  fmt::print("recording    {} bytes into {}, {} messages and changes are missing{}\n",
             status.recorded_bytes, status.recording_folder, status.not_recorded,
             status.recording_trouble.empty() ? "" : "; FAILING: " + status.recording_trouble);
}

/// A planner that was silent for longer counts as lost.
constexpr double kPlannerSilence_s = 1.0;

/// Prints the lines about the planners of a front.
void print_fleet(const DaemonStatus& status) {
  if (status.role != "front") return;
  const auto heard = std::ranges::count_if(status.planners, [](const FleetPlanner& planner) {
    return planner.silent_s < kPlannerSilence_s;
  });
  fmt::print(
      "fleet        {}; {} sent again, {} planned by the front; {}\n",
      plural(static_cast<std::size_t>(heard), "planner"),
      plural(static_cast<std::size_t>(status.jobs_sent_again), "request"), status.planned_here,
      status.log_in_touch ? "the log of scenes is in touch" : "the log of scenes is OUT OF REACH");
  if (status.differing_answers > 0) {
    fmt::print("differing    {} had DIFFERENT ANSWERS of two planners; see the log\n",
               plural(static_cast<std::size_t>(status.differing_answers), "request"));
  }
  for (const FleetPlanner& planner : status.planners) {
    fmt::print("  {}: {} of {} plan, host {}, process {}, {}{}{}, {}\n", planner.id,
               planner.running, planner.workers, planner.host, planner.pid, planner.version,
               planner.is_other_version ? " (ANOTHER VERSION: gets no jobs)" : "",
               planner.is_behind ? ", behind the log" : "",
               planner.silent_s < kPlannerSilence_s
                   ? std::string("heard just now")
                   : fmt::format("LOST: silent for {:.0f} s", planner.silent_s));
  }
}

void print_text(const DaemonStatus& status) {
  fmt::print("camwayd      {}, up {}\n", status.version, duration_text(status.uptime_s));
  fmt::print("workers      {} of {} plan, {} requests wait\n", status.running_requests,
             status.num_workers, status.queued_requests);
  fmt::print(
      "answered     {} ({:.3g}/s since the start), {} requests came again and {} of them were "
      "answered from the cache; {} refused for want of room\n",
      status.answered_requests, per_second(status.answered_requests, status.uptime_s),
      status.repeated_requests, status.cache_hits, status.overloaded_requests);
  fmt::print("plans        {}\n", answers_text(status.plan_answers));
  fmt::print("occupancy    {}\n", answers_text(status.occupancy_answers));
  fmt::print("changes      {}\n", answers_text(status.scene_answers));
  fmt::print("to answer    {}\n", quantiles_text(status.receipt_to_answer));
  fmt::print("waiting      {}\n", quantiles_text(status.waiting));
  fmt::print("planning     {}\n", quantiles_text(status.planning));
  print_traffic(status);
  print_reloads(status);
  print_recording(status);
  print_fleet(status);
  fmt::print("watched      {} paths; {} times one was broken by a change\n", status.watched_paths,
             status.broken_paths);
  fmt::print("scenes       {}, changed {} times, {}\n", status.total_scenes, status.scene_changes,
             status.daemon_start.durable ? "durable" : "volatile: they end with the daemon");
  for (const SceneInfo& scene : status.scenes) {
    fmt::print("  {}: revision {}, {} triangles, {}{}, digest {}\n", scene.name, scene.revision,
               scene.num_triangles,
               scene.occupancy_resolution_m > 0.0
                   ? fmt::format("occupancy at {:g} m", scene.occupancy_resolution_m)
                   : std::string("no occupancy map"),
               bounds_note(scene), scene.digest);
  }
}

/// Returns a line of `--watch`: the changes since the status before, which may be of another
/// daemon.
void print_line(const DaemonStatus& status, const std::optional<DaemonStatus>& before) {
  std::string rate = "-";
  std::string quantiles = "-";
  if (before && status.uptime_s > before->uptime_s) {
    rate = fmt::format("{:.1f}", per_second(status.answered_requests - before->answered_requests,
                                            status.uptime_s - before->uptime_s));
    quantiles = quantiles_text(status.receipt_to_answer.since(before->receipt_to_answer));
  }
  fmt::print(
      "{:%H:%M:%S} up {:<12} planning {:>3} waiting {:>5} answers/s {:>8} refused {:>6} "
      "malformed {:>6} to answer {}\n",
      fmt::localtime(std::time(nullptr)), duration_text(status.uptime_s), status.running_requests,
      status.queued_requests, rate, status.overloaded_requests, status.malformed_messages,
      quantiles);
}

void print(const StatusFlags& flags, const DaemonStatus& status,
           const std::optional<DaemonStatus>& before) {
  if (flags.json) {
    // One line for each status, so that a reader finds its end.
    fmt::print("{}\n", json_text(status_json(status), flags.watch ? -1 : 2));
  } else if (flags.watch) {
    print_line(status, before);
  } else {
    print_text(status);
  }
  std::fflush(stdout);
}

/// Time for a daemon to say whether it is there at all.
constexpr double kProbe_s = 0.3;

/// Says that no heartbeat came within the time of the flags, and whether a daemon is there.
ExitCode report_no_heartbeat(const StatusFlags& flags, Client& client, const DaemonStatus& silent) {
  if (silent.status != Status::kNoDaemon || !client.list_scenes().ok()) {
    return report_failure(silent.status, silent.error, flags.key_file);
  }
  print_error(
      fmt::format("a daemon is there, but no heartbeat of it came within {:g} s; its "
                  "status.period_s may be longer, so wait longer with --timeout-s",
                  flags.timeout_s));
  return ExitCode::kNoDaemon;
}

ExitCode run_status(StatusFlags flags) {
  if (const std::string fault = use_key_file(flags.key_file, flags.client); !fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  flags.client.deadline_s = kProbe_s;
  Client client(flags.client);
  if (!client.good()) {
    print_error(client.error());
    return ExitCode::kInvalidInput;
  }
  if (!client.warning().empty()) print_error(client.warning());
  std::optional<DaemonStatus> before;
  for (std::int64_t heard = 0;;) {
    DaemonStatus status = client.status(flags.timeout_s);
    if (!status.ok()) {
      const ExitCode code = report_no_heartbeat(flags, client, status);
      if (!flags.watch || flags.count > 0) return code;
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
  add_key_file(*command, flags->key_file);
  command
      ->add_option(
          "--timeout-s", flags->timeout_s,
          "How long to wait for a heartbeat, seconds; longer than the daemon's status.period_s")
      ->check(cli_support::between(0.0, 3600.0))
      ->capture_default_str();
  command->add_flag("--json", flags->json,
                    "Print JSON, for machines; with --watch a line for each");
  CLI::Option* watch =
      command->add_flag("--watch", flags->watch, "Go on, with a line for each heartbeat");
  command
      ->add_option("--count", flags->count,
                   "End after so many heartbeats, or the first that "
                   "does not come")
      ->check(cli_support::whole_number(1, std::int64_t{1} << 53))
      ->needs(watch);
  command->footer(exit_code_help("", /*asks_daemon=*/true) + "\nExample: camway status --watch");
  command->callback([flags, &exit_code] { exit_code = run_status(*flags); });
}

}  // namespace camway::tools
