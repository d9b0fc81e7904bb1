// SPDX-License-Identifier: MIT
//
// The crossing campaign at full length, and FCL's results on the same cases.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <thread>

#include "tests/bench/columns.h"
#include "tests/bench/command_line.h"
#include "tests/bench/motion_samples.h"
#include "tests/bench/peers/fcl_peer.h"
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

// The colliding cases of one family that a peer missed.
struct PeerTally {
  std::string family{};
  std::uint64_t cases = 0;
  std::uint64_t missed_discrete = 0;
  std::uint64_t missed_naive = 0;
  std::uint64_t missed_advancement = 0;
};

// FCL's sampled check over the whole path, with at most 1 cm between samples.
bool fcl_sees(const FclPeer& fcl, const CrossingCase& c) {
  const std::vector<MotionSample> samples = motion_samples(c.path, c.camera, 0.01);
  return std::any_of(samples.begin(), samples.end(), [&](const MotionSample& sample) {
    return fcl.collides(motion::pose_at(c.path.segments()[sample.segment], sample.u));
  });
}

// FCL's continuous check between the two samples around the known instant, which are 1 cm apart, or
// a tenth of the body if that is less. It is given the place of the collision.
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
  return {"", 1, fcl_sees(fcl, c) ? 0U : 1U, fcl_sees_between(fcl, c, Continuous::kNaive) ? 0U : 1U,
          fcl_sees_between(fcl, c, Continuous::kConservativeAdvancement) ? 0U : 1U};
}

void add(const PeerTally& one, PeerTally& sum) {
  sum.cases += one.cases;
  sum.missed_discrete += one.missed_discrete;
  sum.missed_naive += one.missed_naive;
  sum.missed_advancement += one.missed_advancement;
}

std::string name_of(std::size_t family) {
  return std::string(to_string(static_cast<CrossingFamily>(family)));
}

std::vector<PeerTally> ask_fcl_all(const Options& options) {
  std::vector<PeerTally> tallies(kCrossingFamilies);
  for (std::size_t f = 0; f < kCrossingFamilies; ++f) tallies[f].family = name_of(f);
  for (std::uint64_t i = 0; i < options.count; ++i) {
    const CrossingCase c = testing::make_crossing_case(options.seed, options.first + i);
    add(ask_fcl(c), tallies[static_cast<std::size_t>(c.family)]);
  }
  return tallies;
}

struct NamedTally {
  std::string family;
  CrossingTally tally;
};

std::vector<Column<NamedTally>> tally_columns() {
  const auto count = [](auto CrossingTally::*member) {
    return [member](const NamedTally& named) -> json { return named.tally.*member; };
  };
  return {
      {"/family", "family", field(&NamedTally::family)},
      {"/cases", "cases", count(&CrossingTally::cases)},
      {"/misses", "misses", count(&CrossingTally::misses)},
      {"/false_alarms", "false alarms", count(&CrossingTally::false_alarms)},
      {"/clearance_above_truth", "clearance above truth",
       count(&CrossingTally::clearance_above_truth)},
      {"/clearance_too_low", "clearance too low", count(&CrossingTally::clearance_too_low)},
      {"/redrawn", "redrawn", count(&CrossingTally::redrawn)},
  };
}

CrossingTally report(const CampaignResult& result, json& document) {
  std::vector<NamedTally> tallies;
  for (std::size_t f = 0; f < kCrossingFamilies; ++f) {
    tallies.push_back({name_of(f), result.families[f]});
  }
  document["families"] = to_json(tally_columns(), tallies);
  const CrossingTally total = result.total();
  tallies.push_back({"all", total});
  document["total"] = to_json(tally_columns(), tallies).back();
  document["faults"] = result.faults;
  print_table(tally_columns(), tallies);
  for (const std::uint64_t index : result.faults) fmt::print("fault in case {}\n", index);
  return total;
}

std::vector<Column<PeerTally>> peer_columns() {
  using P = PeerTally;
  return {
      {"/family", "family", field(&P::family)},
      {"/collisions", "collisions", field(&P::cases)},
      {"/missed_discrete_1cm", "FCL at 1 cm missed", field(&P::missed_discrete)},
      {"/missed_continuous_naive", "FCL continuous (default) missed", field(&P::missed_naive)},
      {"/missed_continuous_advancement", "FCL conservative advancement missed",
       field(&P::missed_advancement)},
  };
}

void report_fcl(const Options& options, json& document) {
  std::vector<PeerTally> tallies;
  PeerTally total{.family = "all"};
  for (PeerTally& tally : ask_fcl_all(options)) {
    if (tally.cases == 0) continue;
    add(tally, total);
    tallies.push_back(std::move(tally));
  }
  document["fcl"] = to_json(peer_columns(), tallies);
  tallies.push_back(total);
  fmt::print("\n");
  print_table(peer_columns(), tallies);
}

int run(const Options& options) {
  const Stopwatch watch;
  const CampaignResult result =
      testing::run_crossing_campaign(options.seed, options.first, options.count, options.threads);
  fmt::print("\n{} crossings, seed {}, from case {}, {} threads, {}\n\n", options.count,
             options.seed, options.first, options.threads, duration_text(watch.seconds()));
  json document = document_of("campaign");
  document["seed"] = options.seed;
  document["first"] = options.first;
  document["seconds"] = watch.seconds();
  const CrossingTally total = report(result, document);
  if (options.peer == "fcl") report_fcl(options, document);
  const int written = finish(document, options.json_file);
  if (!total.faultless()) fmt::print("\nFAULTS: {} misses\n", total.misses);
  return total.faultless() ? written : 1;
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
  camway::bench::add_json_option(app, options.json_file);
  CLI11_PARSE(app, argc, argv);
  return camway::bench::run(options);
}
