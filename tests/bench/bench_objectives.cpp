// SPDX-License-Identifier: MIT
//
// Objectives: how far the answers for `shortest`, `smoothest` and `safest` get from the closest
// path towards the best path that is known.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/bench/fidelity/answers.h"
#include "tests/bench/fidelity/best_by_objective.h"
#include "tests/bench/fidelity/objective_value.h"
#include "tests/bench/fidelity/shot.h"
#include "tests/bench/field_values.h"

namespace camway::bench {
namespace {

using correction::Objective;
using motion::CubicPath;
using nlohmann::json;

constexpr std::array<std::pair<const char*, Objective>, 3> kObjectives{{
    {"shortest", Objective::kShortest},
    {"smoothest", Objective::kSmoothest},
    {"safest", Objective::kSafest},
}};

/// Gains of less than this share of the value of the closest path do not count.
constexpr double kWorthSeeking = 0.01;

struct Options {
  RequestSource source{own_scenes() + "/requests", "", 1.0};
  std::vector<RequestSet> sets;
  std::vector<std::string> objectives{"shortest", "smoothest", "safest"};
  double deadline_s = 10.0;
  SearchEffort effort;
  bool summary_only = false;
  std::string json_file;
};

/// The answer for one objective to a request, between the closest path and the reference.
struct Outcome {
  std::string scene{}, request{}, difficulty{}, objective{}, status{};
  double closest = kUnknown;  ///< values by the objective (`value_of`)
  double answer = kUnknown;
  double start = kUnknown;  ///< of the best start of the reference
  double reference = kUnknown;
  double ratio = kUnknown;      ///< how much less good the answer is than the reference: 1 or more
  double possible = kUnknown;   ///< gain of the reference, as a share of the closest path's value
  double share = kUnknown;      ///< of the possible gain, where that is worth seeking
  bool is_proved = false;       ///< whether the closest path and the answer are
  bool is_closest = false;      ///< whether the answer is the closest path bit for bit
  double time_s = kUnknown;     ///< processor time of the plan
  double closest_s = kUnknown;  ///< the same of the closest path

  [[nodiscard]] bool is_worth_seeking() const { return possible > kWorthSeeking; }
};

bool is_same(const CubicPath& a, const CubicPath& b) {
  return std::ranges::equal(a.pieces, b.pieces,
                            [](const motion::CubicPiece& one, const motion::CubicPiece& other) {
                              return one.t0_s == other.t0_s && one.t1_s == other.t1_s &&
                                     one.position == other.position && one.image == other.image;
                            });
}

double best_value(Objective objective, const Shot& shot, std::span<const CubicPath> paths,
                  std::span<const TimeRange> ranges) {
  double best = kUnknown;
  for (const CubicPath& path : paths) {
    const double value = value_of(objective, shot, path, ranges);
    if (std::isnan(best) || is_worse(objective, best, value)) best = value;
  }
  return best;
}

/// Finds the reference of a request, and compares.
void compare(Objective objective, const Shot& shot, const Answer& closest, const Answer& answer,
             SearchEffort effort, Outcome& outcome) {
  const Extent extent = extent_of(objective, shot, closest.cubic, answer.cubic);
  const std::vector<TimeRange>& ranges = extent.compared;
  if (ranges.empty()) return;
  const std::vector<CubicPath> starts =
      starts_of(objective, shot, closest.cubic, answer.cubic, extent);
  effort.clearance_m = kept_clearance_m(objective, shot, closest.cubic, ranges);
  const CubicPath best = best_by_objective(objective, shot, starts, extent, effort);
  const auto value = [&](const CubicPath& path) { return value_of(objective, shot, path, ranges); };
  outcome.closest = value(closest.cubic);
  outcome.answer = value(answer.cubic);
  outcome.start = best_value(objective, shot, starts, ranges);
  outcome.reference = value(best);
  const bool more_is_better = objective == Objective::kSafest;
  outcome.ratio =
      more_is_better ? outcome.reference / outcome.answer : outcome.answer / outcome.reference;
  const double gain = outcome.closest - outcome.reference;
  outcome.possible = std::abs(gain) / outcome.closest;
  if (outcome.is_worth_seeking()) outcome.share = (outcome.closest - outcome.answer) / gain;
}

std::vector<Outcome> outcomes_of(const BenchScene& scene, const scene::Snapshot& snapshot,
                                 const BenchRequest& request, const Options& options) {
  const Shot shot(snapshot, request, options.deadline_s);
  if (shot.collisions() == 0) return {};
  const Answer closest = planned(shot, shot.plan().options);
  std::vector<Outcome> outcomes;
  for (const auto& [name, objective] : kObjectives) {
    if (std::ranges::find(options.objectives, name) == options.objectives.end()) continue;
    planning::PlanOptions own = shot.plan().options;
    own.objective = objective;
    const Answer answer = planned(shot, own);
    Outcome& outcome = outcomes.emplace_back(Outcome{.scene = scene.name,
                                                     .request = request.name,
                                                     .difficulty = request.difficulty,
                                                     .objective = name,
                                                     .status = answer.status,
                                                     .time_s = answer.time_s,
                                                     .closest_s = closest.time_s});
    outcome.is_proved = closest.is_proved() && answer.is_proved();
    if (!outcome.is_proved) continue;
    outcome.is_closest = is_same(answer.cubic, closest.cubic);
    compare(objective, shot, closest, answer, options.effort, outcome);
  }
  return outcomes;
}

/// One objective's results on the requests of a scene.
struct Summary {
  std::string scene{}, objective{};
  std::size_t runs = 0, proved = 0;
  std::size_t worth = 0;      ///< requests whose possible gain is worth seeking
  std::size_t unchanged = 0;  ///< of these: answers that are the closest path
  std::map<std::string, std::pair<double, double>> of{};
};

/// A measure, and the two shares of the requests that do not exceed its two numbers.
struct Measure {
  const char* name;
  double Outcome::*member;
  double low, high;
};
constexpr std::array<Measure, 8> kMeasures{{
    {"closest", &Outcome::closest, 0.5, 0.9},
    {"answer", &Outcome::answer, 0.5, 0.9},
    {"reference", &Outcome::reference, 0.5, 0.9},
    {"ratio", &Outcome::ratio, 0.5, 0.9},
    {"possible", &Outcome::possible, 0.5, 0.9},
    {"share", &Outcome::share, 0.1, 0.5},
    {"seconds", &Outcome::time_s, 0.5, 0.99},
    {"closest_seconds", &Outcome::closest_s, 0.5, 0.99},
}};

Summary summarise(const std::vector<const Outcome*>& outcomes) {
  Summary summary{.runs = outcomes.size()};
  for (const Outcome* outcome : outcomes) {
    summary.proved += outcome->is_proved ? 1U : 0U;
    summary.worth += outcome->is_worth_seeking() ? 1U : 0U;
    summary.unchanged += outcome->is_worth_seeking() && outcome->is_closest ? 1U : 0U;
  }
  for (const Measure& measure : kMeasures) {
    summary.of[measure.name] = {quantile_of(outcomes, measure.member, measure.low),
                                quantile_of(outcomes, measure.member, measure.high)};
  }
  return summary;
}

std::vector<Summary> summaries(const std::vector<Outcome>& outcomes) {
  std::map<std::tuple<std::string, std::string>, std::vector<const Outcome*>> groups;
  const bool has_scenes = std::ranges::any_of(
      outcomes, [&](const Outcome& outcome) { return outcome.scene != outcomes.front().scene; });
  for (const Outcome& outcome : outcomes) {
    groups[{outcome.scene, outcome.objective}].push_back(&outcome);
    if (has_scenes) groups[{"all", outcome.objective}].push_back(&outcome);
  }
  std::vector<Summary> list;
  for (const auto& [group, members] : groups) {
    Summary& summary = list.emplace_back(summarise(members));
    std::tie(summary.scene, summary.objective) = group;
  }
  return list;
}

/// In percent; "-" where nothing is known.
std::string as_percent(const json& value) {
  const double share = value;
  return std::isfinite(share) ? as_share(value) : "-";
}
std::string as_shares(const json& value) {
  return as_percent(value[0]) + " / " + as_percent(value[1]);
}

Column<Summary> pair_column(const std::string& name, const std::string& title,
                            std::string (*text)(const json&) = as_numbers) {
  const auto value = [name](const Summary& s) -> json {
    return {s.of.at(name).first, s.of.at(name).second};
  };
  return {"/" + name, title, value, text};
}

std::vector<Column<Summary>> summary_columns() {
  using S = Summary;
  return {
      {"/scene", "scene", field(&S::scene)},
      {"/objective", "objective", field(&S::objective)},
      {"/runs", "n", field(&S::runs)},
      {"/proved", "proved", field(&S::proved)},
      pair_column("closest", "closest"),
      pair_column("answer", "answer"),
      pair_column("reference", "best known"),
      pair_column("ratio", "to best"),
      {"/worth", "can gain", field(&S::worth)},
      pair_column("possible", "possible gain", as_shares),
      pair_column("share", "share of it, p10 / p50", as_shares),
      {"/unchanged", "unchanged", field(&S::unchanged)},
      pair_column("seconds", "time, p50 / p99", as_durations),
      pair_column("closest_seconds", "of closest", as_durations),
  };
}

std::vector<Column<Outcome>> outcome_columns() {
  using O = Outcome;
  return {
      {"/scene", "", field(&O::scene)},
      {"/request", "request", field(&O::request)},
      {"/difficulty", "", field(&O::difficulty)},
      {"/objective", "objective", field(&O::objective)},
      {"/status", "status", field(&O::status)},
      {"/proved", "", field(&O::is_proved)},
      {"/closest", "closest", field(&O::closest), as_number},
      {"/answer", "answer", field(&O::answer), as_number},
      {"/start", "best start", field(&O::start), as_number},
      {"/reference", "best known", field(&O::reference), as_number},
      {"/ratio", "to best", field(&O::ratio), as_number},
      {"/possible", "possible gain", field(&O::possible), as_percent},
      {"/share", "share of it", field(&O::share), as_percent},
      {"/is_closest", "is closest", field(&O::is_closest)},
      {"/seconds", "time", field(&O::time_s), as_duration},
      {"/closest_seconds", "of closest", field(&O::closest_s), as_duration},
  };
}

int run(const Options& options) {
  json document = document_of("objectives");
  document["budget_s"] = options.effort.seconds;
  std::vector<Outcome> all;
  for (const BenchScene& scene : load_sets(options.source, options.sets)) {
    const auto snapshot = scene::make_snapshot(scene.name, *scene.mesh).snapshot;
    std::vector<Outcome> outcomes;
    for (const BenchRequest& request : scene.requests) {
      std::ranges::move(outcomes_of(scene, *snapshot, request, options),
                        std::back_inserter(outcomes));
    }
    if (!options.summary_only) {
      fmt::print("\n{}: {} triangles\n\n", scene.name, scene.mesh->triangles.size());
      print_table(outcome_columns(), outcomes);
    }
    std::ranges::move(outcomes, std::back_inserter(all));
  }
  fmt::print(
      "\np50 / p90 over requests with collisions, on the intervals that corrections changed\n\n");
  const std::vector<Summary> list = summaries(all);
  print_table(summary_columns(), list);
  document["requests"] = to_json(outcome_columns(), all);
  document["summaries"] = to_json(summary_columns(), list);
  return finish(document, options.json_file);
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  using namespace camway::bench;
  CLI::App app{"Objectives: how much of the possible gain the answers reach"};
  Options options;
  std::vector<std::string> names;
  for (const auto& [name, objective] : kObjectives) names.emplace_back(name);
  add_request_options(app, options.source);
  add_set_option(app, options.sets);
  app.add_option("--objectives", options.objectives, "the objectives that take part")
      ->delimiter(',')
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  app.add_option("--budget", options.effort.seconds,
                 "processor time of the slow reference for each request and objective, seconds")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--seed", options.effort.seed, "of the slow reference")->capture_default_str();
  app.add_option("--deadline", options.deadline_s, "of each plan, seconds by the wall")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--summary", options.summary_only, "without the table of single requests");
  add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
