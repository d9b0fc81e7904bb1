// SPDX-License-Identifier: MIT
#include "tests/collision/crossing_campaign.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <thread>

#include "daemon/collision/clearance.h"
#include "daemon/scene/field/clearance_field.h"
#include "daemon/scene/field/distance_field.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::testing {

namespace {

using base::Deadline;

constexpr std::size_t kMostFaultsNamed = 20;
constexpr std::uint64_t kCasesPerTurn = 256;

// Returns options with the same ratio as the defaults of detection.
collision::DetectOptions options_for(const CrossingCase& c) {
  collision::DetectOptions options;
  options.joining_distance_m = c.tolerance_m * (options.joining_distance_m / options.tolerance_m);
  options.tolerance_m = c.tolerance_m;
  return options;
}

double path_size_m(const motion::Path& path) {
  geometry::Box box;
  for (const motion::Segment& segment : path.segments()) {
    for (const geometry::Vec3& point : segment.position) box.extend(point);
  }
  return box.diagonal().norm();
}

using Intervals = std::vector<collision::CollisionInterval>;

bool covers(const Intervals& intervals, double time_s) {
  return std::any_of(intervals.begin(), intervals.end(), [&](const auto& interval) {
    return interval.t_begin_s <= time_s && time_s <= interval.t_end_s;
  });
}

// Checks a free case: the certified clearance, and detection with required clearances on both sides
// of the known one.
void ask_clearance(const CrossingCase& c, const collision::Obstacles& obstacles,
                   CrossingTally& tally) {
  const double clearance_m = certified_clearance_m(obstacles, c.path, c.camera);
  tally.clearance_above_truth = clearance_m > c.clearance_below_m ? 1U : 0U;
  tally.clearance_too_low = clearance_m < kLeastClearanceShare * c.clearance_above_m ? 1U : 0U;
  collision::DetectOptions options = options_for(c);
  options.clearance_m = c.clearance_below_m * (1.0 + 1e-9);
  tally.misses +=
      covers(certified_intervals(obstacles, c.path, c.camera, options), c.known_s) ? 0U : 1U;
  options.clearance_m = 0.5 * (c.clearance_above_m - c.tolerance_m);
  tally.false_alarms += certified_intervals(obstacles, c.path, c.camera, options).empty() ? 0U : 1U;
}

void merge(CampaignResult& into, const CampaignResult& part) {
  for (std::size_t f = 0; f < kCrossingFamilies; ++f) into.families[f] += part.families[f];
  into.faults.insert(into.faults.end(), part.faults.begin(), part.faults.end());
}

}  // namespace

std::vector<collision::CollisionInterval> certified_intervals(
    const collision::Obstacles& obstacles, const motion::Path& path, const motion::Camera& camera,
    const collision::DetectOptions& options) {
  return collision::detect_collisions({obstacles, motion::Body(camera), options}, path,
                                      path.begin_s(), path.end_s(), base::Deadline::never())
      .value();
}

double certified_clearance_m(const collision::Obstacles& obstacles, const motion::Path& path,
                             const motion::Camera& camera) {
  return collision::path_clearance(obstacles, path, motion::Body(camera), base::Deadline::never())
      .value()
      .lower_bound_m;
}

bool CrossingTally::faultless() const {
  return misses + false_alarms + clearance_above_truth + clearance_too_low == 0;
}

CrossingTally& CrossingTally::operator+=(const CrossingTally& other) {
  cases += other.cases;
  redrawn += other.redrawn;
  misses += other.misses;
  false_alarms += other.false_alarms;
  clearance_above_truth += other.clearance_above_truth;
  clearance_too_low += other.clearance_too_low;
  return *this;
}

CrossingTally CampaignResult::total() const {
  CrossingTally sum;
  for (const CrossingTally& family : families) sum += family;
  return sum;
}

CrossingTally run_crossing_case(const CrossingCase& c) {
  CrossingTally tally{.cases = 1, .redrawn = std::uint64_t(c.redrawn)};
  const scene::SceneIndex index = scene::SceneIndex::build(c.obstacle, {.threads = 1});
  collision::Obstacles obstacles(index);
  std::optional<scene::ClearanceField> clearance;
  if (c.with_field) {
    const auto field = scene::DistanceField::build(c.obstacle, {.threads = 1});
    if (field) obstacles.field = &clearance.emplace(*field);
  }
  const Intervals found = certified_intervals(obstacles, c.path, c.camera, options_for(c));
  if (c.collides) {
    tally.misses = covers(found, c.known_s) ? 0 : 1;
    return tally;
  }
  tally.false_alarms = found.empty() ? 0 : 1;
  if (c.clearance_above_m >= kLeastClearanceAsked * path_size_m(c.path)) {
    ask_clearance(c, obstacles, tally);
  }
  return tally;
}

CampaignResult run_crossing_campaign(std::uint64_t seed, std::uint64_t first, std::uint64_t count,
                                     unsigned threads) {
  CampaignResult result;
  std::mutex mutex;  // guards result
  std::atomic<std::uint64_t> next = 0;
  const auto work = [&] {
    CampaignResult mine;
    for (std::uint64_t begin; (begin = next.fetch_add(kCasesPerTurn)) < count;) {
      for (std::uint64_t i = begin; i < std::min(count, begin + kCasesPerTurn); ++i) {
        const CrossingCase c = make_crossing_case(seed, first + i);
        const CrossingTally tally = run_crossing_case(c);
        mine.families[static_cast<std::size_t>(c.family)] += tally;
        if (!tally.faultless()) mine.faults.push_back(first + i);
      }
    }
    const std::lock_guard lock(mutex);
    merge(result, mine);
  };
  {
    std::vector<std::jthread> workers;
    for (unsigned i = 1; i < threads; ++i) workers.emplace_back(work);
    work();
  }
  std::sort(result.faults.begin(), result.faults.end());
  result.faults.resize(std::min(result.faults.size(), kMostFaultsNamed));
  return result;
}

}  // namespace camway::testing
