// SPDX-License-Identifier: MIT
//
// Fidelity: how much corrections change the shot, what that costs, and how far it is from the
// cheapest path that is known.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>

#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/bench/fidelity/answers.h"
#include "tests/bench/fidelity/best_known.h"
#include "tests/bench/fidelity/fidelity.h"
#include "tests/bench/fidelity/known_paths.h"
#include "tests/bench/fidelity/other_sides.h"
#include "tests/bench/fidelity/shot.h"
#include "tests/bench/field_values.h"
#include "tests/bench/peers/fcl_peer.h"

namespace camway::bench {
namespace {

using nlohmann::json;

/// The ways of correction.
enum Way : std::size_t {
  kDefault,
  kKeep,
  kPaper,  ///< the paper's method
  kOmplSpline,
  kOmplDense,
  kBestKnown,    ///< with the required clearance
  kBestAsClear,  ///< with the clearance of the default answer
  kWays
};
constexpr std::array<const char*, kWays> kWayNames{
    "default",    "keep",       "keyframe_insertion", "ompl_spline",
    "ompl_dense", "best_known", "best_as_clear"};

/// Share of the default answer's certified clearance that `kBestAsClear` keeps: the certified one
/// is proved by another search than that of collisions.
constexpr double kAsClear = 0.95;

struct Options {
  RequestSource source{own_scenes() + "/requests", "", 1.0};
  std::vector<RequestSet> sets;
  std::vector<std::string> ways{kWayNames.begin(), kWayNames.end()};
  double viewing_distance_m = 3.0;
  double deadline_s = 10.0;
  SearchEffort effort;
  bool summary_only = false;
  std::string known_file;
  std::string json_file;

  [[nodiscard]] bool wants(Way way) const {
    return std::ranges::find(ways, kWayNames[way]) != ways.end();
  }
};

/// The answer of one way to a request, and its measures if the path is proved free.
struct Outcome {
  std::string scene{}, request{}, difficulty{};
  Way way = kDefault;
  std::string status{};
  bool is_proved = false;
  double time_s = kUnknown;
  double turned_deg = kUnknown;
  double shift_deg = kUnknown;
  double moved_m = kUnknown;
  double changed = kUnknown;
  double per_collision = kUnknown;
  double acceleration = kUnknown;
  double clearance_m = kUnknown;
  double length = kUnknown;
  double cost = kUnknown;
  double cost_to_best = kUnknown;
  double cost_to_clear = kUnknown;  ///< to that of `kBestAsClear`
};

constexpr double kDegrees = 180.0 / std::numbers::pi;

Outcome outcome_of(Way way, const Shot& shot, const Answer& answer, double viewing_distance_m) {
  Outcome outcome{.request = shot.request().name,
                  .difficulty = shot.request().difficulty,
                  .way = way,
                  .status = answer.status,
                  .is_proved = answer.is_proved(),
                  .time_s = answer.time_s};
  if (!answer.is_proved()) return outcome;
  const Fidelity fidelity = fidelity_of(answer.path, shot.original(), viewing_distance_m);
  outcome.turned_deg = kDegrees * fidelity.turned_rad;
  outcome.shift_deg = kDegrees * fidelity.shift_rad;
  outcome.moved_m = fidelity.moved_m;
  outcome.changed = fidelity.changed;
  if (shot.collisions() > 0) {
    outcome.per_collision =
        static_cast<double>(answer.inserted) / static_cast<double>(shot.collisions());
  }
  outcome.acceleration = fidelity.acceleration;
  outcome.clearance_m = *answer.clearance_m;
  outcome.length = fidelity.length;
  outcome.cost = shot.cost(answer.cubic);
  return outcome;
}

/// A scene with the structures of all ways.
class Arena {
 public:
  /// Refers to all arguments, which must outlive it.
  Arena(const BenchScene& scene, const Options& options, KnownPaths& known)
      : options_(options),
        known_(known),
        scene_(scene),
        snapshot_(scene::make_snapshot(scene.name, *scene.mesh).snapshot),
        fcl_(*scene.mesh) {
    fcl_.build();
  }

  /// Corrects a request in every way.
  std::vector<Outcome> run(const BenchRequest& request) {
    const Shot shot(*snapshot_, request, options_.deadline_s);
    std::vector<std::pair<Way, Answer>> answers = plans(shot);
    if (options_.wants(kOmplSpline) || options_.wants(kOmplDense)) add_ompl(shot, answers);
    if (options_.wants(kBestKnown)) add_best_known(shot, answers);
    std::vector<Outcome> outcomes;
    for (const auto& [way, answer] : answers) {
      if (!options_.wants(way)) continue;
      outcomes.push_back(outcome_of(way, shot, answer, options_.viewing_distance_m));
      outcomes.back().scene = scene_.name;
    }
    compare_costs(outcomes);
    return outcomes;
  }

 private:
  /// The plans of the ways that take part; the search for the best known begins with all of them.
  std::vector<std::pair<Way, Answer>> plans(const Shot& shot) const {
    const planning::PlanOptions& own = shot.plan().options;
    planning::PlanOptions keep = own;
    keep.orientation.rule = correction::OrientationRule::kKeep;
    planning::PlanOptions paper = own;
    paper.method = planning::Method::kKeyframeInsertion;
    std::vector<std::pair<Way, Answer>> answers;
    answers.emplace_back(kDefault, planned(shot, own));
    const bool all = options_.wants(kBestKnown);
    if (all || options_.wants(kKeep)) answers.emplace_back(kKeep, planned(shot, keep));
    if (all || options_.wants(kPaper)) answers.emplace_back(kPaper, planned(shot, paper));
    return answers;
  }

  void add_ompl(const Shot& shot, std::vector<std::pair<Way, Answer>>& answers) {
    fcl_.set_camera(shot.request().camera);
    OmplAnswers ompl = by_ompl(shot, OmplPeer(fcl_, *scene_.mesh, shot.request().camera));
    answers.emplace_back(kOmplSpline, std::move(ompl.spline));
    answers.emplace_back(kOmplDense, std::move(ompl.dense));
  }

  void add_best_known(const Shot& shot, std::vector<std::pair<Way, Answer>>& answers) {
    std::vector<motion::CubicPath> starts = known_.of(scene_.name, shot);
    const std::optional<double> clearance_m = answers.front().second.clearance_m;
    for (const auto& [way, answer] : answers) {
      if (answer.is_proved()) starts.push_back(answer.cubic);
    }
    if (shot.collisions() > 0) {
      for (Answer& other : other_answers(shot)) starts.push_back(std::move(other.cubic));
      if (clearance_m) {
        std::ranges::move(other_sides(shot, answers.front().second.cubic),
                          std::back_inserter(starts));
      }
    }
    SearchEffort effort = options_.effort;
    effort.clearance_m = shot.plan().options.clearance_m;
    if (options_.wants(kBestAsClear) && clearance_m) {
      SearchEffort clear = effort;
      clear.clearance_m = std::max(effort.clearance_m, kAsClear * *clearance_m);
      answers.emplace_back(kBestAsClear, searched(kBestAsClear, shot, starts, clear));
      // It keeps the required clearance, too.
      if (answers.back().second.is_proved()) starts.push_back(answers.back().second.cubic);
    }
    answers.emplace_back(kBestKnown, searched(kBestKnown, shot, starts, effort));
  }

  Answer searched(Way way, const Shot& shot, std::span<const motion::CubicPath> starts,
                  const SearchEffort& effort) {
    std::optional<Answer> best = best_known(shot, starts, effort);
    if (!best) return {.status = "none", .time_s = kUnknown};
    if (shot.collisions() > 0) known_.keep(scene_.name, shot, kWayNames[way], best->cubic);
    return *std::move(best);
  }

  static void compare_costs(std::vector<Outcome>& outcomes) {
    // A path that is as interpolated costs nothing, or what rounding makes of it.
    const auto ratio = [](double cost, double best) { return cost <= best ? 1.0 : cost / best; };
    for (const Outcome& best : outcomes) {
      for (Outcome& outcome : outcomes) {
        if (best.way == kBestKnown) outcome.cost_to_best = ratio(outcome.cost, best.cost);
        const bool is_as_clear = outcome.way == kDefault || outcome.way == kBestAsClear;
        if (best.way == kBestAsClear && is_as_clear) {
          outcome.cost_to_clear = ratio(outcome.cost, best.cost);
        }
      }
    }
  }

  const Options& options_;
  KnownPaths& known_;
  const BenchScene& scene_;
  const std::shared_ptr<const scene::Snapshot> snapshot_;
  FclPeer fcl_;
};

/// A value that half, and one that nine tenths, of the requests do not exceed. Of a clearance,
/// where less is worse, the second is exceeded by nine tenths.
struct Quantiles {
  double p50 = kUnknown;
  double p90 = kUnknown;
};

/// One way's results on a group of requests.
struct Summary {
  std::string scene{}, group{};
  Way way = kDefault;
  std::size_t runs = 0, proved = 0;
  std::map<std::string, Quantiles> of{};
};

using Member = double Outcome::*;
constexpr std::array<std::pair<const char*, Member>, 11> kMeasures{{
    {"cost_to_best", &Outcome::cost_to_best},
    {"cost_to_clear", &Outcome::cost_to_clear},
    {"turned_deg", &Outcome::turned_deg},
    {"shift_deg", &Outcome::shift_deg},
    {"moved_m", &Outcome::moved_m},
    {"changed", &Outcome::changed},
    {"inserted_per_collision", &Outcome::per_collision},
    {"acceleration", &Outcome::acceleration},
    {"clearance_m", &Outcome::clearance_m},
    {"length", &Outcome::length},
    {"seconds", &Outcome::time_s},
}};

Summary summarise(const std::vector<const Outcome*>& outcomes) {
  Summary summary{.way = outcomes.front()->way, .runs = outcomes.size()};
  for (const Outcome* outcome : outcomes) summary.proved += outcome->is_proved ? 1U : 0U;
  for (const auto& [name, member] : kMeasures) {
    const double far = member == &Outcome::clearance_m ? 0.1 : 0.9;
    summary.of[name] = {quantile_of(outcomes, member, 0.5), quantile_of(outcomes, member, far)};
  }
  return summary;
}

std::vector<Summary> summaries(const std::vector<Outcome>& outcomes) {
  std::map<std::tuple<std::string, std::string, Way>, std::vector<const Outcome*>> groups;
  const bool has_scenes = std::ranges::any_of(
      outcomes, [&](const Outcome& outcome) { return outcome.scene != outcomes.front().scene; });
  for (const Outcome& outcome : outcomes) {
    groups[{outcome.scene, outcome.difficulty, outcome.way}].push_back(&outcome);
    if (has_scenes) groups[{"all", outcome.difficulty, outcome.way}].push_back(&outcome);
  }
  std::vector<Summary> list;
  for (const auto& [group, members] : groups) {
    Summary& summary = list.emplace_back(summarise(members));
    std::tie(summary.scene, summary.group, summary.way) = group;
  }
  return list;
}

std::string as_degrees(const json& value) {
  const double degrees = value;
  return std::isfinite(degrees) ? fmt::format("{:.2f}", degrees) : "-";
}

std::string as_degrees_both(const json& value) {
  return as_degrees(value[0]) + " / " + as_degrees(value[1]);
}

Column<Summary> quantiles_column(const std::string& name, const std::string& title,
                                 std::string (*text)(const json&) = as_numbers) {
  const auto value = [name](const Summary& s) -> json {
    const Quantiles& quantiles = s.of.at(name);
    return {quantiles.p50, quantiles.p90};
  };
  return {"/" + name, title, value, text};
}

std::vector<Column<Summary>> summary_columns() {
  using S = Summary;
  return {
      {"/scene", "scene", field(&S::scene)},
      {"/group", "requests", field(&S::group)},
      {"/way", "by", [](const S& s) -> json { return kWayNames[s.way]; }},
      {"/runs", "n", field(&S::runs)},
      {"/proved", "proved", field(&S::proved)},
      quantiles_column("cost_to_best", "cost to best"),
      quantiles_column("cost_to_clear", "to best as clear"),
      quantiles_column("turned_deg", "turned, °", as_degrees_both),
      quantiles_column("shift_deg", "shift, °", as_degrees_both),
      quantiles_column("moved_m", ""),
      quantiles_column("changed", "changed"),
      quantiles_column("inserted_per_collision", "inserted a collision"),
      quantiles_column("acceleration", "acceleration"),
      quantiles_column("clearance_m", "clearance, m (p10)"),
      quantiles_column("length", "length"),
      quantiles_column("seconds", "time", as_durations),
  };
}

std::vector<Column<Outcome>> outcome_columns() {
  using O = Outcome;
  return {
      {"/scene", "", field(&O::scene)},
      {"/request", "request", field(&O::request)},
      {"/difficulty", "", field(&O::difficulty)},
      {"/way", "by", [](const O& o) -> json { return kWayNames[o.way]; }},
      {"/status", "answer", field(&O::status)},
      {"/proved", "", field(&O::is_proved)},
      {"", "check", [](const O& o) -> json { return o.is_proved ? "proved" : "-"; }},
      {"/cost_rad_s", "cost, rad·s", field(&O::cost), as_number},
      {"/cost_to_best", "to best", field(&O::cost_to_best), as_number},
      {"/cost_to_clear", "as clear", field(&O::cost_to_clear), as_number},
      {"/turned_deg", "turned, °", field(&O::turned_deg), as_degrees},
      {"/shift_deg", "shift, °", field(&O::shift_deg), as_degrees},
      {"/moved_m", "moved, m", field(&O::moved_m), as_number},
      {"/changed", "changed", field(&O::changed), as_number},
      {"/inserted_per_collision", "inserted", field(&O::per_collision), as_number},
      {"/acceleration", "acceleration", field(&O::acceleration), as_number},
      {"/clearance_m", "clearance, m", field(&O::clearance_m), as_number},
      {"/length", "length", field(&O::length), as_number},
      {"/seconds", "time", field(&O::time_s), as_duration},
  };
}

int run(const Options& options) {
  json document = document_of("fidelity");
  document["viewing_distance_m"] = options.viewing_distance_m;
  document["budget_s"] = options.effort.seconds;
  KnownPaths known(options.known_file);
  std::vector<Outcome> all;
  for (const BenchScene& scene : load_sets(options.source, options.sets)) {
    Arena arena(scene, options, known);
    std::vector<Outcome> outcomes;
    for (const BenchRequest& request : scene.requests) {
      std::ranges::move(arena.run(request), std::back_inserter(outcomes));
    }
    if (!options.summary_only) {
      fmt::print("\n{}: {} triangles\n\n", scene.name, scene.mesh->triangles.size());
      print_table(outcome_columns(), outcomes);
    }
    std::ranges::move(outcomes, std::back_inserter(all));
  }
  fmt::print("\np50 / p90 of paths that are proved free; the shift is measured at {} m\n\n",
             options.viewing_distance_m);
  const std::vector<Summary> list = summaries(all);
  print_table(summary_columns(), list);
  document["requests"] = to_json(outcome_columns(), all);
  document["summaries"] = to_json(summary_columns(), list);
  const std::string error = known.write();
  if (!error.empty()) fmt::print(stderr, "bench_fidelity: {}\n", error);
  const int written = finish(document, options.json_file);
  return error.empty() ? written : 1;
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  using namespace camway::bench;
  CLI::App app{"Fidelity: how much each way of correction changes the shot"};
  Options options;
  add_request_options(app, options.source);
  add_set_option(app, options.sets);
  app.add_option("--ways", options.ways, "the ways that take part; best_as_clear needs best_known")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(kWayNames.begin(), kWayNames.end())))
      ->capture_default_str();
  app.add_option("--budget", options.effort.seconds,
                 "processor time of the slow reference for each request, seconds")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--seed", options.effort.seed, "of the slow reference")->capture_default_str();
  app.add_option("--viewing-distance", options.viewing_distance_m,
                 "at which the shift of the picture is measured, metres")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--deadline", options.deadline_s,
                 "of each plan, seconds: by the wall for ours, of processor time for OMPL")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--known", options.known_file,
                 "file of the best paths that are known: read, if it exists, and written");
  app.add_flag("--summary", options.summary_only, "without the table of single requests");
  add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
