// SPDX-License-Identifier: MIT
//
// Certified detection against sampled checks with FCL and with Embree, request by request.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "tests/bench/camway_side.h"
#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/bench/motion_samples.h"
#include "tests/bench/peers/embree_peer.h"
#include "tests/bench/peers/fcl_peer.h"

namespace camway::bench {
namespace {

using nlohmann::json;

constexpr double kCoarseStep_m = 0.01;
constexpr double kFineStep_m = 0.001;

constexpr double kNotRun = std::numeric_limits<double>::quiet_NaN();

// The contenders, in the order of the columns.
enum Contender { kDetect, kCheck, kFclCoarse, kFclFine, kEmbreeRays, kEmbreePacket };
constexpr std::size_t kContenders = 6;
constexpr std::array<const char*, kContenders> kContenderNames{
    "camway_detect", "camway_check", "fcl_1cm", "fcl_1mm", "embree_rays_1cm", "embree_packet_1cm"};

struct Outcome {
  const BenchRequest* request = nullptr;
  std::array<double, kContenders> median_s{};
  std::vector<collision::CollisionInterval> intervals;
  double clearance_m = 0.0;
  /// For each peer: the intervals that it found, and the number of certified intervals that it
  /// missed.
  std::array<std::size_t, kContenders> seen{};
  std::array<std::size_t, kContenders> missed{};
  /// Certified intervals that contain a pose which exact predicates show to collide.
  std::size_t shown = 0;
  std::size_t samples_1cm = 0;

  [[nodiscard]] bool free() const { return intervals.empty(); }
  [[nodiscard]] double embree_s() const {
    return std::min(median_s[kEmbreeRays], median_s[kEmbreePacket]);
  }
};

struct Options {
  RequestSource source{own_scenes() + "/requests", "", 1.0};
  std::string json_file;
  double tolerance_m = default_options().tolerance_m;
  int rounds = 5;
  bool fine = true;

  [[nodiscard]] collision::DetectOptions detect() const {
    collision::DetectOptions detect = default_options();
    detect.tolerance_m = tolerance_m;
    detect.joining_distance_m = std::max(detect.joining_distance_m, tolerance_m);
    return detect;
  }
};

// A scene with the structures of all contenders.
class Arena {
 public:
  explicit Arena(const BenchScene& scene)
      : camway_(scene.mesh), fcl_(*scene.mesh), embree_(*scene.mesh, 1) {
    fcl_.build();
    embree_.build();
  }

  Outcome run(const BenchRequest& request, const Options& options) {
    fcl_.set_camera(request.camera);
    embree_.set_camera(request.camera);
    const std::vector<MotionSample> coarse =
        motion_samples(request.path, request.camera, kCoarseStep_m);
    const std::vector<MotionSample> fine =
        options.fine ? motion_samples(request.path, request.camera, kFineStep_m) : coarse;

    Outcome outcome;
    outcome.request = &request;
    outcome.samples_1cm = coarse.size();
    std::array<SampledIntervals, kContenders> sampled;
    const auto fcl = [&](const motion::Pose& pose) { return fcl_.collides(pose); };
    const auto rays = [&](const motion::Pose& pose) { return embree_.collides_by_rays(pose); };
    const auto packet = [&](const motion::Pose& pose) { return embree_.collides_by_packet(pose); };
    std::array<std::vector<double>, kContenders> times_s;
    for (int round = 0; round < options.rounds; ++round) {
      times_s[kDetect].push_back(warm_s([&] {
        outcome.intervals = testing::certified_intervals(camway_.obstacles(), request.path,
                                                         request.camera, options.detect());
      }));
      times_s[kFclCoarse].push_back(
          warm_s([&] { sampled[kFclCoarse] = check_samples(request.path, coarse, fcl); }));
      times_s[kCheck].push_back(warm_s([&] {
        outcome.clearance_m =
            check_whole(camway_.obstacles(), request.path, request.camera, options.detect())
                .certificate.clearance_lower_bound_m;
      }));
      times_s[kEmbreeRays].push_back(
          warm_s([&] { sampled[kEmbreeRays] = check_samples(request.path, coarse, rays); }));
      times_s[kEmbreePacket].push_back(
          warm_s([&] { sampled[kEmbreePacket] = check_samples(request.path, coarse, packet); }));
      if (options.fine) {
        times_s[kFclFine].push_back(
            warm_s([&] { sampled[kFclFine] = check_samples(request.path, fine, fcl); }));
      }
    }
    summarise_rounds(times_s, outcome);
    compare(sampled, outcome);
    return outcome;
  }

 private:
  static void summarise_rounds(const std::array<std::vector<double>, kContenders>& times_s,
                               Outcome& outcome) {
    for (std::size_t k = 0; k < kContenders; ++k) {
      outcome.median_s[k] = times_s[k].empty() ? kNotRun : median(times_s[k]);
    }
  }

  void compare(const std::array<SampledIntervals, kContenders>& sampled, Outcome& outcome) const {
    for (const std::size_t k : {kFclCoarse, kFclFine, kEmbreeRays, kEmbreePacket}) {
      outcome.seen[k] = sampled[k].begin_s.size();
    }
    for (const collision::CollisionInterval& interval : outcome.intervals) {
      const BenchRequest& request = *outcome.request;
      if (!shown_colliding(camway_.index(), request.camera, request.path, interval)) continue;
      ++outcome.shown;
      for (const std::size_t k : {kFclCoarse, kFclFine, kEmbreeRays, kEmbreePacket}) {
        if (std::isnan(outcome.median_s[k])) continue;
        const bool blind = !sampled[k].sees(interval.t_begin_s, interval.t_end_s);
        outcome.missed[k] += blind ? 1 : 0;
      }
    }
  }

  CamwayScene camway_;
  FclPeer fcl_;
  EmbreePeer embree_;
};

struct Summary {
  std::string scene;
  std::string group;
  std::size_t requests = 0;
  std::array<double, kContenders> p50_s{};
  /// Medians over requests of the ratios of time: how many times faster detection is.
  double fcl_1cm = 0.0;
  double fcl_1mm = 0.0;
  double embree = 0.0;  ///< to the faster of the two
  double embree_rays = 0.0;
  double check_fcl_1cm = 0.0;
  std::size_t intervals = 0, shown = 0;
  std::array<std::size_t, kContenders> missed{};
};

Summary summarise(const std::string& scene, const std::string& group,
                  const std::vector<const Outcome*>& outcomes) {
  Summary summary{.scene = scene, .group = group, .requests = outcomes.size()};
  const auto over = [&](const auto& value) {
    std::vector<double> values;
    for (const Outcome* outcome : outcomes) values.push_back(value(*outcome));
    return median(values);
  };
  for (std::size_t k = 0; k < kContenders; ++k) {
    summary.p50_s[k] = over([&](const Outcome& o) { return o.median_s[k]; });
    for (const Outcome* outcome : outcomes) summary.missed[k] += outcome->missed[k];
  }
  summary.fcl_1cm =
      over([](const Outcome& o) { return o.median_s[kFclCoarse] / o.median_s[kDetect]; });
  summary.fcl_1mm =
      over([](const Outcome& o) { return o.median_s[kFclFine] / o.median_s[kDetect]; });
  summary.embree = over([](const Outcome& o) { return o.embree_s() / o.median_s[kDetect]; });
  summary.embree_rays =
      over([](const Outcome& o) { return o.median_s[kEmbreeRays] / o.median_s[kDetect]; });
  summary.check_fcl_1cm =
      over([](const Outcome& o) { return o.median_s[kFclCoarse] / o.median_s[kCheck]; });
  for (const Outcome* outcome : outcomes) {
    summary.intervals += outcome->intervals.size();
    summary.shown += outcome->shown;
  }
  return summary;
}

std::vector<Summary> summaries(const std::string& scene, const std::vector<Outcome>& outcomes) {
  std::map<std::string, std::vector<const Outcome*>> groups;
  for (const Outcome& outcome : outcomes) {
    groups[outcome.request->difficulty].push_back(&outcome);
    groups[outcome.free() ? "all without collision" : "all with collisions"].push_back(&outcome);
  }
  std::vector<Summary> list;
  for (const auto& [group, members] : groups) list.push_back(summarise(scene, group, members));
  return list;
}

template <class Counts>
json missed_text(const Counts& counts, double fine_s) {
  const std::string fine = std::isnan(fine_s) ? "-" : std::to_string(counts.missed[kFclFine]);
  return fmt::format("{} / {} / {} of {}", counts.missed[kFclCoarse], fine,
                     counts.missed[kEmbreeRays], counts.shown);
}

// Returns the values of `array` for each contender from `first` on, under its name.
template <class Item, class Array>
void add_columns(std::vector<Column<Item>>& columns, const std::string& pointer,
                 const Array Item::*array, std::size_t first = kDetect) {
  for (std::size_t k = first; k < kContenders; ++k) {
    columns.push_back({pointer + kContenderNames[k], "",
                       [array, k](const Item& item) -> json { return (item.*array)[k]; }});
  }
}

std::vector<Column<Outcome>> outcome_columns() {
  using O = Outcome;
  const auto time = [](Contender k) { return [k](const O& o) -> json { return o.median_s[k]; }; };
  std::vector<Column<O>> columns{
      {"/name", "request", [](const O& o) -> json { return o.request->name; }},
      {"/difficulty", "", [](const O& o) -> json { return o.request->difficulty; }},
      {"/keyframes", "", [](const O& o) -> json { return o.request->keyframes; }},
      {"/segments", "", [](const O& o) -> json { return o.request->path.segments().size(); }},
      {"/samples_1cm", "", field(&O::samples_1cm)},
      {"/intervals", "intervals", [](const O& o) -> json { return o.intervals.size(); }},
      {"/intervals_shown_colliding", "", field(&O::shown)},
      {"/clearance_lower_bound_m", "", field(&O::clearance_m)},
      {"", "detect", time(kDetect), as_duration},
      {"", "check", time(kCheck), as_duration},
      {"", "FCL 1 cm", time(kFclCoarse), as_duration},
      {"", "Embree 1 cm", [](const O& o) -> json { return o.embree_s(); }, as_duration},
      {"/ratio_fcl_1cm", "to FCL",
       [](const O& o) -> json { return o.median_s[kFclCoarse] / o.median_s[kDetect]; }, as_ratio},
      {"/ratio_embree_1cm", "to Embree",
       [](const O& o) -> json { return o.embree_s() / o.median_s[kDetect]; }, as_ratio},
      {"", "missed by FCL 1 cm / 1 mm / Embree",
       [](const O& o) { return missed_text(o, o.median_s[kFclFine]); }},
  };
  add_columns(columns, "/seconds/", &O::median_s);
  add_columns(columns, "/intervals_seen/", &O::seen, kFclCoarse);
  add_columns(columns, "/intervals_missed/", &O::missed, kFclCoarse);
  return columns;
}

std::vector<Column<Summary>> summary_columns() {
  using S = Summary;
  const auto time = [](Contender k) { return [k](const S& s) -> json { return s.p50_s[k]; }; };
  std::vector<Column<S>> columns{
      {"/scene", "scene", field(&S::scene)},
      {"/group", "requests", field(&S::group)},
      {"/requests", "n", field(&S::requests)},
      {"/intervals", "", field(&S::intervals)},
      {"/intervals_shown_colliding", "", field(&S::shown)},
      {"", "detect p50", time(kDetect), as_duration},
      {"", "check p50", time(kCheck), as_duration},
      {"", "FCL 1 cm p50", time(kFclCoarse), as_duration},
      {"", "FCL 1 mm p50", time(kFclFine), as_duration},
      {"", "Embree 1 cm p50, packets", time(kEmbreePacket), as_duration},
      {"", "single rays", time(kEmbreeRays), as_duration},
      {"/median_ratio_fcl_1cm", "ratio FCL 1 cm", field(&S::fcl_1cm), as_ratio},
      {"/median_ratio_fcl_1mm", "ratio FCL 1 mm", field(&S::fcl_1mm), as_ratio},
      {"/median_ratio_embree_1cm", "ratio Embree packets", field(&S::embree), as_ratio},
      {"/median_ratio_embree_single_rays_1cm", "single rays", field(&S::embree_rays), as_ratio},
      {"/median_ratio_check_fcl_1cm", "", field(&S::check_fcl_1cm)},
      {"", "missed by FCL 1 cm / 1 mm / Embree",
       [](const S& s) { return missed_text(s, s.p50_s[kFclFine]); }},
  };
  add_columns(columns, "/p50_seconds/", &S::p50_s);
  add_columns(columns, "/intervals_missed/", &S::missed);
  return columns;
}

int run(const Options& options) {
  json document = document_of("detect");
  document["rounds"] = options.rounds;
  document["tolerance_m"] = options.tolerance_m;
  std::vector<Summary> all;
  for (const BenchScene& scene : load_requests(options.source)) {
    Arena arena(scene);
    std::vector<Outcome> outcomes;
    for (const BenchRequest& request : scene.requests) {
      outcomes.push_back(arena.run(request, options));
    }
    fmt::print("\n{}: {} triangles, medians of {} rounds\n\n", scene.name,
               scene.mesh->triangles.size(), options.rounds);
    print_table(outcome_columns(), outcomes);
    document["scenes"].push_back({{"name", scene.name},
                                  {"triangles", scene.mesh->triangles.size()},
                                  {"requests", to_json(outcome_columns(), outcomes)}});
    for (const Summary& summary : summaries(scene.name, outcomes)) all.push_back(summary);
  }
  fmt::print(
      "\nmedians over requests; a ratio is how many times faster than the peer detection is\n\n");
  print_table(summary_columns(), all);
  document["summaries"] = to_json(summary_columns(), all);
  return finish(document, options.json_file);
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{"Certified detection on one thread against FCL and Embree at samples"};
  camway::bench::Options options;
  camway::bench::add_request_options(app, options.source);
  app.add_option("--tolerance", options.tolerance_m, "of ends of intervals, metres")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  camway::bench::add_rounds_option(app, options.rounds);
  app.add_flag("!--no-fine", options.fine, "leave out FCL at 1 mm, which takes most of the time");
  camway::bench::add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
