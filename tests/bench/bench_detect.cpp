// SPDX-License-Identifier: MIT
//
// Certified detection against sampled checks with FCL and with Embree, request by request.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <CLI/CLI.hpp>

#include "tests/bench/camway_side.h"
#include "tests/bench/embree_peer.h"
#include "tests/bench/fcl_peer.h"
#include "tests/bench/measure.h"
#include "tests/bench/motion_samples.h"
#include "tests/bench/request_set.h"

namespace camway::bench {
namespace {

using nlohmann::json;

constexpr double kCoarseStep_m = 0.01;
constexpr double kFineStep_m = 0.001;

constexpr double kNotRun = std::numeric_limits<double>::quiet_NaN();

// Who is timed, in the order of the columns.
enum Contender { kDetect, kCheck, kFclCoarse, kFclFine, kEmbreeRays, kEmbreePacket };
constexpr std::size_t kContenders = 6;
constexpr std::array<const char*, kContenders> kContenderNames{
    "camway_detect", "camway_check", "fcl_1cm", "fcl_1mm", "embree_rays_1cm", "embree_packet_1cm"};

struct Outcome {
  const BenchRequest* request = nullptr;
  std::array<double, kContenders> median_s{};
  std::vector<collision::CollisionInterval> intervals;
  double clearance_m = 0.0;
  /// Of each peer: intervals it saw, and how many of ours it saw nothing in.
  std::array<std::size_t, kContenders> seen{};
  std::array<std::size_t, kContenders> missed{};
  /// Certified intervals in which a pose was shown to collide, by exact predicates.
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
    detect.gap_m = std::max(detect.gap_m, tolerance_m);
    return detect;
  }
};

// One scene with everybody's structures.
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
      if (!shown_colliding(*outcome.request, interval)) continue;
      ++outcome.shown;
      for (const std::size_t k : {kFclCoarse, kFclFine, kEmbreeRays, kEmbreePacket}) {
        if (std::isnan(outcome.median_s[k])) continue;
        const bool blind = !sampled[k].sees(interval.t_begin_s, interval.t_end_s);
        outcome.missed[k] += blind ? 1 : 0;
      }
    }
  }

  // Whether some pose in the interval collides without doubt; an interval may be there only because
  // the resolution ended.
  [[nodiscard]] bool shown_colliding(const BenchRequest& request,
                                     const collision::CollisionInterval& interval) const {
    constexpr int kLooks = 500;
    for (int i = 0; i <= kLooks; ++i) {
      const double share = static_cast<double>(i) / kLooks;
      const double time_s = interval.t_begin_s + share * (interval.t_end_s - interval.t_begin_s);
      if (touches_at(camway_.index(), request.camera, request.path.pose(time_s))) return true;
    }
    return false;
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
  /// Medians of the ratios of single requests: how many times faster detection is.
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

json to_json(const Outcome& outcome) {
  json entry{{"name", outcome.request->name},
             {"difficulty", outcome.request->difficulty},
             {"keyframes", outcome.request->keyframes},
             {"segments", outcome.request->path.segments().size()},
             {"samples_1cm", outcome.samples_1cm},
             {"intervals", outcome.intervals.size()},
             {"intervals_shown_colliding", outcome.shown},
             {"clearance_lower_bound_m", outcome.clearance_m},
             {"ratio_fcl_1cm", outcome.median_s[kFclCoarse] / outcome.median_s[kDetect]},
             {"ratio_embree_1cm", outcome.embree_s() / outcome.median_s[kDetect]}};
  for (std::size_t k = 0; k < kContenders; ++k) {
    entry["seconds"][kContenderNames[k]] = outcome.median_s[k];
    if (k >= kFclCoarse) entry["intervals_seen"][kContenderNames[k]] = outcome.seen[k];
    if (k >= kFclCoarse) entry["intervals_missed"][kContenderNames[k]] = outcome.missed[k];
  }
  return entry;
}

json to_json(const Summary& summary) {
  json entry{{"scene", summary.scene},
             {"group", summary.group},
             {"requests", summary.requests},
             {"intervals", summary.intervals},
             {"intervals_shown_colliding", summary.shown},
             {"median_ratio_fcl_1cm", summary.fcl_1cm},
             {"median_ratio_fcl_1mm", summary.fcl_1mm},
             {"median_ratio_embree_1cm", summary.embree},
             {"median_ratio_embree_single_rays_1cm", summary.embree_rays},
             {"median_ratio_check_fcl_1cm", summary.check_fcl_1cm}};
  for (std::size_t k = 0; k < kContenders; ++k) {
    entry["p50_seconds"][kContenderNames[k]] = summary.p50_s[k];
    entry["intervals_missed"][kContenderNames[k]] = summary.missed[k];
  }
  return entry;
}

double fine_s(const Outcome& outcome) { return outcome.median_s[kFclFine]; }
double fine_s(const Summary& summary) { return summary.p50_s[kFclFine]; }

template <class Counts>
std::string missed_text(const Counts& counts) {
  const std::string fine =
      std::isnan(fine_s(counts)) ? "-" : std::to_string(counts.missed[kFclFine]);
  return fmt::format("{} / {} / {}", counts.missed[kFclCoarse], fine, counts.missed[kEmbreeRays]);
}

void print_requests(const std::vector<Outcome>& outcomes) {
  Table table({"request", "intervals", "detect", "check", "FCL 1 cm", "Embree 1 cm", "to FCL",
               "to Embree", "missed by FCL 1 cm / 1 mm / Embree"});
  for (const Outcome& o : outcomes) {
    table.add({o.request->name, std::to_string(o.intervals.size()),
               duration_text(o.median_s[kDetect]), duration_text(o.median_s[kCheck]),
               duration_text(o.median_s[kFclCoarse]), duration_text(o.embree_s()),
               ratio_text(o.median_s[kFclCoarse] / o.median_s[kDetect]),
               ratio_text(o.embree_s() / o.median_s[kDetect]),
               missed_text(o) + fmt::format(" of {}", o.shown)});
  }
  table.print();
}

void print_summaries(const std::vector<Summary>& list) {
  Table table({"scene", "requests", "n", "detect p50", "check p50", "FCL 1 cm p50", "FCL 1 mm p50",
               "Embree 1 cm p50, packets", "single rays", "ratio FCL 1 cm", "ratio FCL 1 mm",
               "ratio Embree packets", "single rays", "collisions",
               "missed by FCL 1 cm / 1 mm / Embree"});
  for (const Summary& s : list) {
    table.add({s.scene, s.group, std::to_string(s.requests), duration_text(s.p50_s[kDetect]),
               duration_text(s.p50_s[kCheck]), duration_text(s.p50_s[kFclCoarse]),
               duration_text(s.p50_s[kFclFine]), duration_text(s.p50_s[kEmbreePacket]),
               duration_text(s.p50_s[kEmbreeRays]), ratio_text(s.fcl_1cm), ratio_text(s.fcl_1mm),
               ratio_text(s.embree), ratio_text(s.embree_rays), std::to_string(s.shown),
               missed_text(s)});
  }
  table.print();
}

int run(const Options& options) {
  json document{{"benchmark", "detect"},
                {"machine", machine()},
                {"rounds", options.rounds},
                {"tolerance_m", options.tolerance_m}};
  std::vector<Summary> all;
  for (const BenchScene& scene : load_requests(options.source)) {
    Arena arena(scene);
    std::vector<Outcome> outcomes;
    for (const BenchRequest& request : scene.requests) {
      outcomes.push_back(arena.run(request, options));
    }
    fmt::print("\n{}: {} triangles, medians of {} rounds\n\n", scene.name,
               scene.mesh->triangles.size(), options.rounds);
    print_requests(outcomes);
    json entry{{"name", scene.name}, {"triangles", scene.mesh->triangles.size()}};
    for (const Outcome& outcome : outcomes) entry["requests"].push_back(to_json(outcome));
    document["scenes"].push_back(entry);
    for (const Summary& summary : summaries(scene.name, outcomes)) all.push_back(summary);
  }
  fmt::print(
      "\nmedians over requests; a ratio is how many times faster than the peer detection is\n\n");
  print_summaries(all);
  for (const Summary& summary : all) document["summaries"].push_back(to_json(summary));
  const std::string error = write_json(options.json_file, document);
  if (!error.empty()) fmt::print(stderr, "bench_detect: {}\n", error);
  return error.empty() ? 0 : 1;
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{"Certified detection on one thread against FCL and Embree at samples"};
  camway::bench::Options options;
  app.add_option("--requests", options.source.requests, "folder of requests, or one request")
      ->capture_default_str();
  app.add_option("--scene", options.source.scene,
                 "scene of all requests, instead of the one named");
  app.add_option("--scale", options.source.scale, "multiplies the scene's coordinates")
      ->capture_default_str();
  app.add_option("--only", options.source.only, "requests with this in their name alone");
  app.add_option("--tolerance", options.tolerance_m, "of ends of intervals, metres")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--rounds", options.rounds, "repetitions")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_flag("!--no-fine", options.fine, "leave out FCL at 1 mm, which takes most of the time");
  app.add_option("--json", options.json_file, "write all numbers to this file");
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
