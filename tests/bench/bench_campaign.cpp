// SPDX-License-Identifier: MIT
//
// The crossing campaign at full length, and what FCL makes of the same cases.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <thread>

#include <CLI/CLI.hpp>

#include "tests/bench/fcl_peer.h"
#include "tests/bench/measure.h"
#include "tests/bench/motion_samples.h"
#include "tests/collision/crossing_campaign.h"

namespace camway::bench {
namespace {

using nlohmann::json;
using testing::CampaignResult;
using testing::CrossingCase;
using testing::CrossingFamily;
using testing::CrossingTally;
using testing::kCrossingFamilies;

struct Options {
  std::uint64_t count = 1'000'000;
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::string peer;
  std::string json_file;
};

// What a peer missed of the colliding cases of one family.
struct PeerTally {
  std::uint64_t cases = 0;
  std::uint64_t missed_discrete = 0;
  std::uint64_t missed_naive = 0;
  std::uint64_t missed_advancement = 0;
};

// FCL's sampled check, with no more than 1 cm between samples, over the whole path.
bool fcl_sees(const FclPeer& fcl, const CrossingCase& c) {
  const std::vector<MotionSample> samples = motion_samples(c.path, c.camera, 0.01);
  return std::any_of(samples.begin(), samples.end(), [&](const MotionSample& sample) {
    return fcl.collides(motion::pose_at(c.path.segments()[sample.segment], sample.u));
  });
}

// FCL's continuous check of the two samples about the known instant, 1 cm apart or a tenth of the
// body if that is less: it is handed the place where the collision is.
bool fcl_sees_between(const FclPeer& fcl, const CrossingCase& c, FclPeer::Continuous solver) {
  const double radius_m = motion::body_radius_m(motion::near_corners_C(c.camera));
  const std::vector<MotionSample> samples =
      motion_samples(c.path, c.camera, std::min(0.01, 0.1 * radius_m));
  const auto after = std::find_if(samples.begin() + 1, samples.end(),
                                  [&](const MotionSample& s) { return s.time_s >= c.known_s; });
  const MotionSample& to = *after;
  const MotionSample& from = *(after - 1);
  const auto pose = [&](const MotionSample& s) {
    return motion::pose_at(c.path.segments()[s.segment], s.u);
  };
  return fcl.collides_between(pose(from), pose(to), solver);
}

PeerTally ask_fcl(const CrossingCase& c) {
  if (!c.collides) return {};
  FclPeer fcl(c.obstacle);
  fcl.build();
  fcl.set_camera(c.camera);
  using Continuous = FclPeer::Continuous;
  return {1, fcl_sees(fcl, c) ? 0U : 1U, fcl_sees_between(fcl, c, Continuous::kNaive) ? 0U : 1U,
          fcl_sees_between(fcl, c, Continuous::kConservativeAdvancement) ? 0U : 1U};
}

std::array<PeerTally, kCrossingFamilies> ask_fcl_all(const Options& options) {
  std::array<PeerTally, kCrossingFamilies> tallies;
  for (std::uint64_t i = 0; i < options.count; ++i) {
    const CrossingCase c = testing::make_crossing_case(options.seed, options.first + i);
    const PeerTally one = ask_fcl(c);
    PeerTally& sum = tallies[static_cast<std::size_t>(c.family)];
    sum.cases += one.cases;
    sum.missed_discrete += one.missed_discrete;
    sum.missed_naive += one.missed_naive;
    sum.missed_advancement += one.missed_advancement;
  }
  return tallies;
}

std::string name_of(std::size_t family) {
  return std::string(to_string(static_cast<CrossingFamily>(family)));
}

json to_json(const std::string& name, const CrossingTally& tally) {
  return {{"family", name},
          {"cases", tally.cases},
          {"redrawn", tally.redrawn},
          {"misses", tally.misses},
          {"false_alarms", tally.false_alarms},
          {"clearance_above_truth", tally.clearance_above_truth},
          {"clearance_too_low", tally.clearance_too_low}};
}

void add_row(Table& table, const std::string& name, const CrossingTally& tally) {
  table.add({name, std::to_string(tally.cases), std::to_string(tally.misses),
             std::to_string(tally.false_alarms), std::to_string(tally.clearance_above_truth),
             std::to_string(tally.clearance_too_low), std::to_string(tally.redrawn)});
}

CrossingTally report(const CampaignResult& result, json& document) {
  Table table({"family", "cases", "misses", "false alarms", "clearance above truth",
               "clearance too low", "redrawn"});
  for (std::size_t f = 0; f < kCrossingFamilies; ++f) {
    add_row(table, name_of(f), result.families[f]);
    document["families"].push_back(to_json(name_of(f), result.families[f]));
  }
  const CrossingTally total = result.total();
  add_row(table, "all", total);
  document["total"] = to_json("all", total);
  document["faults"] = result.faults;
  table.print();
  for (const std::uint64_t index : result.faults) fmt::print("fault in case {}\n", index);
  return total;
}

void report_fcl(const Options& options, json& document) {
  const auto tallies = ask_fcl_all(options);
  Table table({"family", "collisions", "FCL at 1 cm missed", "FCL continuous (default) missed",
               "FCL conservative advancement missed"});
  PeerTally total;
  for (std::size_t f = 0; f < kCrossingFamilies; ++f) {
    const PeerTally& t = tallies[f];
    if (t.cases == 0) continue;
    table.add({name_of(f), std::to_string(t.cases), std::to_string(t.missed_discrete),
               std::to_string(t.missed_naive), std::to_string(t.missed_advancement)});
    document["fcl"].push_back({{"family", name_of(f)},
                               {"collisions", t.cases},
                               {"missed_discrete_1cm", t.missed_discrete},
                               {"missed_continuous_naive", t.missed_naive},
                               {"missed_continuous_advancement", t.missed_advancement}});
    total.cases += t.cases;
    total.missed_discrete += t.missed_discrete;
    total.missed_naive += t.missed_naive;
    total.missed_advancement += t.missed_advancement;
  }
  table.add({"all", std::to_string(total.cases), std::to_string(total.missed_discrete),
             std::to_string(total.missed_naive), std::to_string(total.missed_advancement)});
  fmt::print("\n");
  table.print();
}

int run(const Options& options) {
  const Stopwatch watch;
  const CampaignResult result =
      testing::run_crossing_campaign(options.seed, options.first, options.count, options.threads);
  fmt::print("\n{} crossings, seed {}, from case {}, {} threads, {}\n\n", options.count,
             options.seed, options.first, options.threads, duration_text(watch.seconds()));
  json document{{"benchmark", "campaign"},
                {"machine", machine()},
                {"seed", options.seed},
                {"first", options.first},
                {"seconds", watch.seconds()}};
  const CrossingTally total = report(result, document);
  if (options.peer == "fcl") report_fcl(options, document);
  const std::string error = write_json(options.json_file, document);
  if (!error.empty()) fmt::print(stderr, "bench_campaign: {}\n", error);
  if (!total.faultless()) fmt::print("\nFAULTS: {} misses\n", total.misses);
  return error.empty() && total.faultless() ? 0 : 1;
}

}  // namespace
}  // namespace camway::bench

int main(int argc, char** argv) {
  CLI::App app{
      "Thin-wall and grazing crossings whose truth is known; exit code 1 if any is missed"};
  camway::bench::Options options;
  app.add_option("--count", options.count, "cases")->capture_default_str();
  app.add_option("--seed", options.seed, "of the campaign")->capture_default_str();
  app.add_option("--first", options.first, "first case; with --count 1 to repeat one")
      ->capture_default_str();
  app.add_option("--threads", options.threads, "threads, without influence on the result")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--peer", options.peer, "ask FCL about the same cases as well, on one thread")
      ->check(CLI::IsMember({"fcl"}));
  app.add_option("--json", options.json_file, "write all numbers to this file");
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
