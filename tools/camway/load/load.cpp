// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/planning/plan.h"
#include "daemon/process/settings/scene_argument.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/daemon_failure.h"
#include "tools/camway/common/key_file.h"
#include "tools/camway/common/request_file.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/camway/load/load_occupancy.h"
#include "tools/camway/load/load_run.h"
#include "tools/json/json_request.h"
#include "tools/json/json_text.h"
#include "tools/support/client_request.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

using OrderedJson = nlohmann::ordered_json;

struct LoadFlags {
  std::string scene;
  std::vector<std::string> requests;
  std::size_t occupancy_queries = 0;  ///< queries of a batch; 0: plan requests
  LoadOptions run;
  std::string key_file;
  double warm_up_s = 0.0;
  std::optional<double> max_growth_percent;
  std::string json_file;
};

ExitCode invalid_input(std::string_view message) {
  print_error(message);
  return ExitCode::kInvalidInput;
}

/// The requests and their scene.
struct LoadPlan {
  LoadScene scene;
  std::vector<LoadRequest> requests;
};

/// Returns the requests of the command line with their local answers. On an error, prints it and
/// returns none.
LoadPlan make_plan(const LoadFlags& flags) {
  const auto parsed = process::parse_scene_argument(flags.scene);
  if (!parsed) {
    print_error("--scene " + flags.scene + ": " + parsed.error);
    return {};
  }
  // Planning does not use the occupancy map, so none is made.
  scene::SnapshotOptions options = parsed->options;
  options.occupancy_resolution_m.reset();
  const LoadedScene scene = load_timed(parsed->name, parsed->file.string(), options);
  if (!scene.result.snapshot) {
    print_error(scene.result.error);
    return {};
  }
  LoadPlan plan{{parsed->name, scene.result.snapshot->digest}, {}};
  for (const std::string& file : flags.requests) {
    const base::Result<RequestFile> request = read_request(file);
    if (!request) {
      print_error(request.error);
      return {};
    }
    warn_of_reading(source_of(file), *request);
    plan.requests.push_back({source_of(file), to_client_request(*request, parsed->name),
                             planning::plan(*scene.result.snapshot, *request)});
  }
  return plan;
}

OrderedJson percentiles_json(const std::vector<float>& values) {
  const Percentiles p = percentiles(values);
  return {{"p50", p.p50}, {"p99", p.p99}, {"p999", p.p999}, {"max", p.max}};
}

OrderedJson result_json(const LoadFlags& flags, const LoadResult& result) {
  const LoadTally& tally = result.tally;
  OrderedJson json;
  json["clients"] = flags.run.clients;
  json["elapsed_s"] = result.elapsed_s;
  json["requests"] = tally.asked;
  json["answered"] = tally.answered;
  json["refused"] = tally.refused;
  json["wrong"] = tally.wrong;
  json["lost"] = tally.lost;
  json["retries"] = tally.retries;
  json["answers_per_s"] = static_cast<double>(tally.answered) / result.elapsed_s;
  json["planners"] = result.planners;
  json["planner_slots"] = result.planner_slots;
  json["by_status"] = tally.by_status;
  json["invalid"] = tally.invalid;
  json["latency_ms"] = percentiles_json(tally.latency_ms);
  json["latency_without_planning_ms"] = percentiles_json(tally.overhead_ms);
  if (flags.run.daemon_pid != 0) {
    json["memory_growth"] = memory_growth(result.memory, flags.warm_up_s);
    json["memory"] = OrderedJson::array();
    for (const MemorySample& sample : result.memory) {
      json["memory"].push_back({{"time_s", sample.time_s}, {"resident_mb", sample.resident_mb}});
    }
  }
  return json;
}

/// Returns the number of answers of each status: "12 ok, 3 partial".
std::string status_list(const LoadTally& tally) {
  std::string list;
  for (const auto& [status, count] : tally.by_status) {
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, status);
  }
  return list;
}

/// Returns the exit code of a run. Prints which requests are invalid.
ExitCode outcome_of(const LoadFlags& flags, const LoadResult& result) {
  const LoadTally& tally = result.tally;
  const bool grew =
      flags.max_growth_percent &&
      100.0 * memory_growth(result.memory, flags.warm_up_s) > *flags.max_growth_percent;
  ExitCode code =
      tally.wrong > 0 || tally.lost > 0 || grew ? ExitCode::kNegative : ExitCode::kSuccess;
  if (tally.by_status.contains(to_string(Status::kNoDaemon))) {
    print_error("the daemon fell silent meanwhile");
    code = worse(code, ExitCode::kNoDaemon);
  }
  for (const auto& [file, reason] : tally.invalid) {
    code = worse(code, invalid_input(file + ": the daemon answers " + reason));
  }
  return code;
}

std::string summary(const LoadFlags& flags, const LoadResult& result) {
  const LoadTally& tally = result.tally;
  const Percentiles all = percentiles(tally.latency_ms);
  const Percentiles without = percentiles(tally.overhead_ms);
  std::string text = fmt::format(
      "{} requests of {} clients in {:.1f} s: {} answered ({:.0f} a second), {} refused, {} wrong, "
      "{} lost, {} retries\n",
      tally.asked, flags.run.clients, result.elapsed_s, tally.answered,
      static_cast<double>(tally.answered) / result.elapsed_s, tally.refused, tally.wrong,
      tally.lost, tally.retries);
  if (result.planners > 0) {
    text +=
        fmt::format("fleet of {} planners with {} slots: {:.1f} answers a second for each slot\n",
                    result.planners, result.planner_slots,
                    static_cast<double>(tally.answered) / result.elapsed_s / result.planner_slots);
  }
  text += fmt::format("by status: {}\n", status_list(tally));
  text += fmt::format("latency, ms:              p50 {:.3f}  p99 {:.3f}  p999 {:.3f}  max {:.3f}\n",
                      all.p50, all.p99, all.p999, all.max);
  text +=
      fmt::format("latency less planning, ms: p50 {:.3f}  p99 {:.3f}  p999 {:.3f}  max {:.3f}\n",
                  without.p50, without.p99, without.p999, without.max);
  if (!result.memory.empty()) {
    text += fmt::format(
        "memory of process {}: {:.1f} MB at first, {:.1f} MB at last, {:+.2f} % "
        "after the first {:g} s\n",
        flags.run.daemon_pid, result.memory.front().resident_mb, result.memory.back().resident_mb,
        100.0 * memory_growth(result.memory, flags.warm_up_s), flags.warm_up_s);
  }
  for (const std::string& complaint : tally.complaints) text += complaint + "\n";
  return text;
}

ExitCode load_occupancy(const LoadFlags& flags) {
  const auto parsed = process::parse_scene_argument(flags.scene);
  if (!parsed) return invalid_input("--scene " + flags.scene + ": " + parsed.error);
  if (!parsed->options.occupancy_resolution_m) {
    return invalid_input("--scene " + flags.scene + ": needs ,occupancy=RESOLUTION_M");
  }
  const LoadedScene scene = load_timed(parsed->name, parsed->file.string(), parsed->options);
  if (!scene.result.snapshot) return invalid_input(scene.result.error);
  const scene::Snapshot& snapshot = *scene.result.snapshot;
  const OccupancyLoad load =
      run_occupancy_load(*snapshot.occupancy, snapshot.index.bounds(),
                         {snapshot.name, snapshot.digest}, flags.occupancy_queries, flags.run);
  if (load.batches == 0) return report_failure(load.status, load.error, flags.key_file);
  const Percentiles latency = percentiles(load.latency_ms);
  fmt::print(
      "{} batches of {} queries by {} clients in {:.1f} s: {:.0f} queries a second, {} batches "
      "wrong, {} lost\nlatency of a batch, ms: p50 {:.3f}  p99 {:.3f}  max {:.3f}\n",
      load.batches, flags.occupancy_queries, flags.run.clients, load.elapsed_s,
      static_cast<double>(load.queries) / load.elapsed_s, load.wrong, load.lost, latency.p50,
      latency.p99, latency.max);
  if (!load.error.empty()) print_error(load.error);
  return load.wrong + load.lost > 0 ? ExitCode::kNegative : ExitCode::kSuccess;
}

ExitCode run_command(LoadFlags flags) {
  if (!wire::is_prefix(flags.run.prefix)) {
    return invalid_input("--prefix " + flags.run.prefix +
                         ": must be 1 to 11 letters, digits, '-' or '_'");
  }
  if (flags.run.daemon_pid != 0 && !(resident_mb(flags.run.daemon_pid) > 0.0)) {
    return invalid_input(fmt::format("--daemon-pid: there is no process {}", flags.run.daemon_pid));
  }
  ClientOptions signing;
  if (const std::string fault = use_key_file(flags.key_file, signing); !fault.empty()) {
    return invalid_input(fault);
  }
  flags.run.authentication = signing.authentication;
  if (flags.occupancy_queries > 0) return load_occupancy(flags);
  if (flags.requests.empty()) {
    return invalid_input("either --request or --occupancy says what is asked");
  }
  if (!flags.json_file.empty()) {
    const std::string fault = why_unwritable(flags.json_file, flags.requests);
    if (!fault.empty()) return invalid_input(fault);
  }
  const LoadPlan plan = make_plan(flags);
  if (plan.requests.empty()) return ExitCode::kInvalidInput;
  const LoadResult result = run_load(plan.scene, plan.requests, flags.run);
  if (!result.error.empty()) return report_failure(result.status, result.error, flags.key_file);
  fmt::print("{}", summary(flags, result));
  if (!flags.json_file.empty()) {
    const std::string error =
        write_file(flags.json_file, json_text(result_json(flags, result), 2) + "\n");
    if (!error.empty()) return invalid_input(error);
  }
  return outcome_of(flags, result);
}

void add_run_flags(CLI::App& command, LoadFlags& flags) {
  command.add_option("--clients", flags.run.clients, "Clients that ask at the same time")
      ->check(cli_support::whole_number(1, 256))
      ->capture_default_str();
  command.add_option("--seconds", flags.run.seconds, "How long to begin requests")
      ->check(cli_support::between(0.1, 1e7))
      ->capture_default_str();
  command
      .add_option("--requests", flags.run.requests,
                  "Stop after so many requests of all clients together; 0: only by time")
      ->check(cli_support::at_least_0())
      ->capture_default_str();
  add_key_file(command, flags.key_file);
  command.add_option("--url", flags.run.url, "LCM network [LCM_DEFAULT_URL]");
  command.add_option("--prefix", flags.run.prefix, "Prefix of the daemon's channels")
      ->capture_default_str();
}

void add_memory_flags(CLI::App& command, LoadFlags& flags) {
  CLI::Option* pid = command
                         .add_option("--daemon-pid", flags.run.daemon_pid,
                                     "Process of the daemon on this machine: watch its memory")
                         ->check(cli_support::above_0());
  command
      .add_option("--warm-up-s", flags.warm_up_s,
                  "With --daemon-pid: growth counts from then on, when caches are full")
      ->check(cli_support::at_least_0())
      ->needs(pid)
      ->capture_default_str();
  command
      .add_option("--max-growth-percent", flags.max_growth_percent,
                  "With --daemon-pid: more growth of its memory is a negative outcome")
      ->check(cli_support::at_least_0())
      ->needs(pid);
}

}  // namespace

void add_load_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<LoadFlags>();
  CLI::App* command = app.add_subcommand(
      "load", "Load a running daemon with many clients; measure it and check every answer");
  command
      ->add_option("--scene", flags->scene,
                   "The scene that the daemon holds by that name, for planning the same here; as "
                   "camwayd's")
      ->type_name(process::kSceneArgumentForm)
      ->required();
  command->add_option("--request", flags->requests, "Request files, asked in turn")
      ->type_name("FILE");
  command
      ->add_option("--occupancy", flags->occupancy_queries,
                   "Ask the scene's occupancy map instead, in batches of so many queries of all "
                   "kinds")
      ->check(cli_support::whole_number(1, 1'000'000))
      ->excludes("--request");
  add_run_flags(*command, *flags);
  add_memory_flags(*command, *flags);
  command->add_option("--json", flags->json_file, "Write the measurements to this file");
  command->footer(
      "Answers to plan requests count as wrong unless every number of path, keyframes and "
      "collisions has the bits that planning here gives.\nA request that is answered `invalid` is "
      "invalid input.\n" +
      exit_code_help("an answer was wrong or lost, or memory grew by more than allowed",
                     /*asks_daemon=*/true) +
      "\nExample: camway load --scene office=scenes/office.obj --request "
      "scenes/requests/office-graze-*.json --clients 8 --seconds 5");
  command->callback([flags, &exit_code] { exit_code = run_command(*flags); });
}

}  // namespace camway::tools
