// SPDX-License-Identifier: MIT
//
// Correction: Camway's methods compared with each other and with OMPL and FCL, on each request.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <tuple>

#include "daemon/planning/plan.h"
#include "tests/bench/camway_side.h"
#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/bench/field_values.h"
#include "tests/bench/peers/ompl_peer.h"

namespace camway::bench {
namespace {

using nlohmann::json;
using planning::PlanResult;
using planning::Status;

// Tolerance for the check of all contenders' paths. A path that cannot be shown free at a tenth of
// this counts as colliding: wrong paths, and paths that come that near to the scene.
constexpr double kCheckTolerance_m = 1e-6;

// Relative change of velocity below which a path counts as straight up to rounding. The ratio of
// another path's bending to it has no meaning.
constexpr double kStraight = 1e-6;

// The contenders. The others are compared with the first.
enum Contender { kLadder, kKeyframeInsertion, kRrtConnect, kBitStar };
constexpr std::size_t kContenders = 4;
constexpr std::array<const char*, kContenders> kContenderNames{"ladder", "keyframe_insertion",
                                                               "rrt_connect", "bit_star"};

bool is_ours(std::size_t contender) { return contender <= kKeyframeInsertion; }

struct Options {
  RequestSource source{own_scenes() + "/requests", "", 1.0};
  std::vector<RequestSet> sets;  // in place of `source`
  std::vector<std::string> contenders{kContenderNames.begin(), kContenderNames.end()};
  double deadline_s = 10.0;
  int rounds = 1;
  bool summary_only = false;
  std::string json_file;

  [[nodiscard]] bool wants(std::size_t contender) const {
    return std::ranges::find(contenders, kContenderNames[contender]) != contenders.end();
  }
};

// The result of one contender on a request, in one round.
struct Outcome {
  const BenchRequest* request = nullptr;
  std::size_t contender = kLadder;
  std::string status{};  // of our answers; "solved" or "gave up" of peers
  double time_s = 0.0;
  bool found = false;    // says that it has a path free of collision
  bool refuted = false;  // and our check says otherwise
  bool shown = false;    // by a pose, too, that collides by exact predicates
  double length_m = kUnknown;
  // Measures relative to the path as interpolated; for Camway only.
  double deviation_m = kUnknown;
  double bending_ratio = kUnknown;
  double acceleration_ratio = kUnknown;
  double inserted = kUnknown;
  // Ratios to the other contenders on the same request and round.
  double time_ratio = kUnknown;    // how many times longer than the ladder it took
  double length_ratio = kUnknown;  // to the shortest that is not refuted

  [[nodiscard]] bool counts() const { return found && !refuted; }
};

void add_measures(const PlanResult& result, Outcome& outcome) {
  if (!result.measures || !result.measures_before) return;
  const motion::PathMeasures& now = *result.measures;
  const motion::PathMeasures& before = *result.measures_before;
  outcome.length_m = now.length_m;
  outcome.deviation_m = now.largest_deviation_m;
  outcome.inserted = static_cast<double>(std::ranges::count(
      result.keyframes, motion::KeyframeOrigin::kInserted, &motion::Keyframe::origin));
  const double turning = before.largest_acceleration_m_per_s2 * before.length_m /
                         std::pow(before.largest_speed_m_per_s, 2);
  if (turning < kStraight) return;
  outcome.bending_ratio = now.bending_energy_m2_per_s3 / before.bending_energy_m2_per_s3;
  outcome.acceleration_ratio =
      now.largest_acceleration_m_per_s2 / before.largest_acceleration_m_per_s2;
}

double length_of(std::span<const motion::Pose> poses) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length_m += (poses[i].position - poses[i - 1].position).norm();
  }
  return length_m;
}

// A scene with the structures of all contenders.
class Arena {
 public:
  Arena(const BenchScene& scene, const Options& options)
      : options_(options),
        mesh_(*scene.mesh),
        snapshot_(scene::make_snapshot(scene.name, *scene.mesh).snapshot),
        fcl_(mesh_) {
    fcl_.build();
  }

  // Runs every contender once, in turn.
  std::vector<Outcome> run(const BenchRequest& request) {
    fcl_.set_camera(request.camera);
    std::vector<Outcome> round;
    for (std::size_t k = 0; k < kContenders; ++k) {
      if (!options_.wants(k)) continue;
      Outcome& outcome = round.emplace_back(Outcome{.request = &request, .contender = k});
      if (is_ours(k)) {
        run_ours(outcome);
      } else {
        run_peer(outcome);
      }
    }
    hold_against_each_other(round);
    return round;
  }

 private:
  void run_ours(Outcome& outcome) const {
    planning::PlanRequest request = outcome.request->plan;
    request.options.deadline_s = options_.deadline_s;
    request.options.method = *base::value_of<planning::Method>(kContenderNames[outcome.contender]);
    PlanResult result;
    outcome.time_s = warm_s([&] { result = planning::plan(*snapshot_, request); });
    outcome.status = planning::to_string(result.status);
    outcome.found = result.status == Status::kOk;
    if (!outcome.found) return;
    add_measures(result, outcome);
    motion::Camera camera = request.camera;
    camera.near_m *= result.near_scale;
    examine(result.path, camera, outcome);
  }

  void run_peer(Outcome& outcome) const {
    const BenchRequest& request = *outcome.request;
    const OmplPeer ompl(fcl_, mesh_, request.camera);
    const auto planner = outcome.contender == kRrtConnect ? OmplPeer::Planner::kRrtConnect
                                                          : OmplPeer::Planner::kBitStar;
    // Runs only once: the best of several runs would favour a randomised planner.
    const double begin_s = thread_seconds();
    const std::optional<PolylineWay> way =
        ompl.plan(request.plan.keyframes, planner, options_.deadline_s);
    outcome.time_s = thread_seconds() - begin_s;
    outcome.found = way.has_value();
    outcome.status = outcome.found ? "solved" : "gave up";
    if (!outcome.found) return;
    outcome.length_m = length_of(way->poses);
    examine(straight_path(way->poses), request.camera, outcome);
  }

  // Checks every contender's path in the same way.
  void examine(const motion::Path& path, const motion::Camera& camera, Outcome& outcome) const {
    collision::DetectOptions options = default_options();
    options.tolerance_m = kCheckTolerance_m;
    const collision::Obstacles obstacles(*snapshot_);
    const planning::PathCheck check = check_whole(obstacles, path, camera, options);
    outcome.refuted = !check.certificate.certified;
    outcome.shown = std::ranges::any_of(check.collisions, [&](const auto& interval) {
      return shown_colliding(snapshot_->index, camera, path, interval);
    });
  }

  static void hold_against_each_other(std::vector<Outcome>& round) {
    double shortest_m = std::numeric_limits<double>::infinity();
    for (const Outcome& outcome : round) {
      if (outcome.counts()) shortest_m = std::min(shortest_m, outcome.length_m);
    }
    for (Outcome& outcome : round) {
      if (outcome.counts()) outcome.length_ratio = outcome.length_m / shortest_m;
      if (round.front().contender != kLadder) continue;
      outcome.time_ratio = outcome.time_s / round.front().time_s;
    }
  }

  const Options& options_;
  const scene::Mesh& mesh_;
  const std::shared_ptr<const scene::Snapshot> snapshot_;
  FclPeer fcl_;
};

// A contender's results on a group of requests.
struct Summary {
  std::string scene{}, group{};
  std::size_t contender = kLadder;
  std::size_t runs = 0, found = 0, infeasible = 0, refuted = 0, shown = 0;
  double p50_s = 0.0, p99_s = 0.0;
  double ratio_of_medians = kUnknown, median_ratio = kUnknown;  // to the ladder's time
  double length_ratio = kUnknown, worst_length_ratio = kUnknown;
  double deviation_m = kUnknown, worst_deviation_m = kUnknown;
  double bending_ratio = kUnknown, acceleration_ratio = kUnknown;
  double inserted = kUnknown;
};

Summary summarise(const std::vector<const Outcome*>& outcomes) {
  Summary s{.contender = outcomes.front()->contender, .runs = outcomes.size()};
  for (const Outcome* outcome : outcomes) {
    s.found += outcome->found ? 1U : 0U;
    s.infeasible += outcome->status == planning::to_string(Status::kInfeasible) ? 1U : 0U;
    s.refuted += outcome->refuted ? 1U : 0U;
    s.shown += outcome->shown ? 1U : 0U;
  }
  s.p50_s = quantile_of(outcomes, &Outcome::time_s, 0.5);
  s.p99_s = quantile_of(outcomes, &Outcome::time_s, 0.99);
  s.median_ratio = quantile_of(outcomes, &Outcome::time_ratio, 0.5);
  s.length_ratio = quantile_of(outcomes, &Outcome::length_ratio, 0.5);
  s.worst_length_ratio = quantile_of(outcomes, &Outcome::length_ratio, 1.0);
  s.deviation_m = quantile_of(outcomes, &Outcome::deviation_m, 0.5);
  s.worst_deviation_m = quantile_of(outcomes, &Outcome::deviation_m, 1.0);
  s.bending_ratio = quantile_of(outcomes, &Outcome::bending_ratio, 0.5);
  s.acceleration_ratio = quantile_of(outcomes, &Outcome::acceleration_ratio, 0.5);
  s.inserted = mean_of(outcomes, &Outcome::inserted);
  return s;
}

// A scene and a group of requests, in the order of the summary.
using Group = std::pair<std::string, std::string>;
using Groups = std::map<Group, std::array<std::vector<const Outcome*>, kContenders>>;

std::vector<Summary> summaries(const Groups& groups) {
  std::vector<Summary> list;
  for (const auto& [group, by_contender] : groups) {
    const std::vector<const Outcome*>& ladder = by_contender[kLadder];
    for (const std::vector<const Outcome*>& outcomes : by_contender) {
      if (outcomes.empty()) continue;
      Summary summary = summarise(outcomes);
      std::tie(summary.scene, summary.group) = group;
      summary.ratio_of_medians = summary.p50_s / quantile_of(ladder, &Outcome::time_s, 0.5);
      list.push_back(std::move(summary));
    }
  }
  return list;
}

template <class Item>
json name_of_contender(const Item& item) {
  return kContenderNames[item.contender];
}

std::vector<Column<Outcome>> outcome_columns() {
  using O = Outcome;
  return {
      {"/request", "request", [](const O& o) -> json { return o.request->name; }},
      {"/difficulty", "", [](const O& o) -> json { return o.request->difficulty; }},
      {"/contender", "by", name_of_contender<O>},
      {"/status", "answer", field(&O::status)},
      {"/seconds", "time", field(&O::time_s), as_duration},
      {"/time_to_ladder", "to ladder", field(&O::time_ratio), as_ratio},
      {"/refuted", "", field(&O::refuted)},
      {"/shown_colliding", "", field(&O::shown)},
      {"", "check",
       [](const O& o) -> json { return !o.found    ? "-"
                                       : o.refuted ? "REFUTED"
                                                   : "ok"; }},
      {"/length_m", "length, m", field(&O::length_m), as_number},
      {"/length_to_shortest", "to shortest", field(&O::length_ratio), as_ratio},
      {"/largest_deviation_m", "deviation, m", field(&O::deviation_m), as_number},
      {"/bending_energy_to_original", "bending", field(&O::bending_ratio), as_ratio},
      {"/acceleration_to_original", "acceleration", field(&O::acceleration_ratio), as_ratio},
      {"/inserted_keyframes", "inserted", field(&O::inserted), as_number},
  };
}

std::vector<Column<Summary>> summary_columns() {
  using S = Summary;
  return {
      {"/scene", "scene", field(&S::scene)},
      {"/group", "requests", field(&S::group)},
      {"/contender", "by", name_of_contender<S>},
      {"/runs", "n", field(&S::runs)},
      {"/found", "", field(&S::found)},
      {"", "solved",
       [](const S& s) -> json {
         return static_cast<double>(s.found) / static_cast<double>(s.runs);
       },
       as_share},
      {"/infeasible", "infeasible", field(&S::infeasible)},
      {"/refuted", "refuted", field(&S::refuted)},
      {"/shown_colliding", "shown", field(&S::shown)},
      {"/p50_seconds", "p50", field(&S::p50_s), as_duration},
      {"/p99_seconds", "p99", field(&S::p99_s), as_duration},
      {"/ratio_of_median_times", "ratio of p50", field(&S::ratio_of_medians), as_ratio},
      {"/median_time_ratio", "median ratio", field(&S::median_ratio), as_ratio},
      {"/median_length_to_shortest", "length", field(&S::length_ratio), as_ratio},
      {"/worst_length_to_shortest", "worst", field(&S::worst_length_ratio), as_ratio},
      {"/median_deviation_m", "deviation, m", field(&S::deviation_m), as_number},
      {"/worst_deviation_m", "worst", field(&S::worst_deviation_m), as_number},
      {"/median_bending_ratio", "bending", field(&S::bending_ratio), as_ratio},
      {"/median_acceleration_ratio", "acceleration", field(&S::acceleration_ratio), as_ratio},
      {"/mean_inserted", "inserted", field(&S::inserted), as_tenths},
  };
}

// Returns whether an `ok` of Camway was refuted, which must not happen.
bool wrong(const Outcome& outcome) {
  if (!is_ours(outcome.contender) || !outcome.refuted) return false;
  fmt::print(stderr, "bench_correct: {} by {} is refuted\n", outcome.request->name,
             kContenderNames[outcome.contender]);
  return true;
}

int run(const Options& options) {
  json document = document_of("correct");
  document["rounds"] = options.rounds;
  document["deadline_s"] = options.deadline_s;
  const std::vector<BenchScene> scenes = load_sets(options.source, options.sets);
  std::vector<std::vector<Outcome>> of_scenes;  // kept: the groups refer to them
  for (const BenchScene& scene : scenes) {
    Arena arena(scene, options);
    std::vector<Outcome>& outcomes = of_scenes.emplace_back();
    for (const BenchRequest& request : scene.requests) {
      for (int round = 0; round < options.rounds; ++round) {
        std::ranges::move(arena.run(request), std::back_inserter(outcomes));
      }
    }
    document["scenes"].push_back({{"name", scene.name},
                                  {"triangles", scene.mesh->triangles.size()},
                                  {"requests", to_json(outcome_columns(), outcomes)}});
    if (options.summary_only) continue;
    fmt::print("\n{}: {} triangles\n\n", scene.name, scene.mesh->triangles.size());
    print_table(outcome_columns(), outcomes);
  }
  Groups groups;
  bool faultless = true;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (const Outcome& outcome : of_scenes[i]) {
      faultless = !wrong(outcome) && faultless;
      const std::string& difficulty = outcome.request->difficulty;
      groups[{scenes[i].name, difficulty}][outcome.contender].push_back(&outcome);
      if (scenes.size() > 1) groups[{"all", difficulty}][outcome.contender].push_back(&outcome);
    }
  }
  const std::vector<Summary> list = summaries(groups);
  fmt::print(
      "\ntimes: a ratio is how many times longer than the ladder it took; lengths: to the shortest "
      "in the run that is not refuted; bending energy and largest acceleration: to the "
      "original\n\n");
  print_table(summary_columns(), list);
  document["summaries"] = to_json(summary_columns(), list);
  const int written = finish(document, options.json_file);
  return faultless ? written : 1;
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  using namespace camway::bench;
  CLI::App app{"Correction: the ladder, keyframe insertion, and OMPL with FCL, side by side"};
  Options options;
  add_request_options(app, options.source);
  add_set_option(app, options.sets);
  app.add_option("--contenders", options.contenders, "who takes part")
      ->delimiter(',')
      ->check(
          CLI::IsMember(std::vector<std::string>(kContenderNames.begin(), kContenderNames.end())))
      ->capture_default_str();
  app.add_option("--deadline", options.deadline_s,
                 "of each, seconds: by the wall for ours, of "
                 "processor time for peers")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--summary", options.summary_only, "without the table of single requests");
  add_rounds_option(app, options.rounds);
  add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
