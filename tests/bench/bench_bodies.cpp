// SPDX-License-Identifier: MIT
//
// Bodies through holes that are little larger than they are, a ring off its pole, and a robot
// through a door.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "daemon/planning/plan.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/bench/narrow_bodies.h"

namespace camway::bench {
namespace {

struct Options {
  std::vector<std::string> bodies{kNarrowBodies.begin(), kNarrowBodies.end()};
  std::vector<double> spares = {0.01, 0.02, 0.05, 0.1};
  std::uint32_t cases = 4;
  std::uint32_t first_seed = 0;
  double deadline_s = 20.0;
  std::string json_file;
};

/// The results of one body with one size of the hole.
struct Group {
  std::string body;
  double spare = 0.0;
  std::size_t runs = 0;
  std::size_t ok = 0;
  double median_s = 0.0;
  double longest_s = 0.0;
  double median_turn_deg = 0.0;
  double largest_turn_deg = 0.0;
};

/// The largest turn of the corrections. [Units: degrees]
double turned_deg(const planning::PlanResult& result) {
  double largest_rad = 0.0;
  for (const correction::Correction& correction : result.corrections)
    largest_rad = std::max(largest_rad, correction.turned_rad);
  return largest_rad * 180.0 / std::numbers::pi;
}

Group run(std::size_t body, double spare, const Options& options) {
  Group group{std::string(kNarrowBodies[body]), spare};
  std::vector<double> times_s;
  std::vector<double> turns_deg;
  for (std::uint32_t i = 0; i < options.cases; ++i) {
    NarrowCase narrow = narrow_case(body, spare, options.first_seed + i);
    narrow.request.options.deadline_s = options.deadline_s;
    const auto snapshot = scene::make_snapshot(group.body, narrow.scene).snapshot;
    const double begin_s = thread_seconds();
    const planning::PlanResult result = planning::plan(*snapshot, narrow.request);
    times_s.push_back(thread_seconds() - begin_s);
    ++group.runs;
    if (result.status != planning::Status::kOk) continue;
    ++group.ok;
    turns_deg.push_back(turned_deg(result));
  }
  if (!turns_deg.empty()) {
    std::ranges::sort(turns_deg);
    group.median_turn_deg = turns_deg[turns_deg.size() / 2];
    group.largest_turn_deg = turns_deg.back();
  }
  std::ranges::sort(times_s);
  group.median_s = times_s[times_s.size() / 2];
  group.longest_s = times_s.back();
  return group;
}

int bench(int argc, char** argv) {
  CLI::App app("Bodies: how many are led through holes little larger than they are");
  Options options;
  app.add_option("--body", options.bodies, "the bodies that are led")
      ->check(CLI::IsMember(options.bodies));
  app.add_option("--spare", options.spares, "room to spare in the hole, as shares of the body")
      ->capture_default_str();
  app.add_option("--cases", options.cases, "cases of each body and size")->capture_default_str();
  app.add_option("--seed", options.first_seed, "of the first case")->capture_default_str();
  app.add_option("--deadline", options.deadline_s, "of each plan, seconds")->capture_default_str();
  add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  std::vector<Group> groups;
  for (std::size_t body = 0; body < kNarrowBodies.size(); ++body) {
    if (std::ranges::find(options.bodies, kNarrowBodies[body]) == options.bodies.end()) continue;
    for (const double spare : options.spares) groups.push_back(run(body, spare, options));
  }
  const std::vector<Column<Group>> columns = {
      {"/body", "body", field(&Group::body)},
      {"/spare", "room to spare", field(&Group::spare), as_share},
      {"/runs", "n", field(&Group::runs)},
      {"/ok", "ok", field(&Group::ok)},
      {"/seconds/p50", "time p50", field(&Group::median_s), as_duration},
      {"/seconds/max", "longest", field(&Group::longest_s), as_duration},
      {"/turned_deg/p50", "turned p50, deg", field(&Group::median_turn_deg), as_tenths},
      {"/turned_deg/max", "largest", field(&Group::largest_turn_deg), as_tenths},
  };
  print_table(columns, groups);
  std::size_t runs = 0;
  std::size_t ok = 0;
  for (const Group& group : groups) {
    runs += group.runs;
    ok += group.ok;
  }
  fmt::print("{} of {} led through\n", ok, runs);
  nlohmann::json document = document_of("bodies");
  document["groups"] = to_json(columns, groups);
  return finish(document, options.json_file);
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) { return camway::bench::bench(argc, argv); }
