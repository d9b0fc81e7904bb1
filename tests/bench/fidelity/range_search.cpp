// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/range_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/planning/stages/path_check.h"
#include "tests/bench/fidelity/local_search.h"

namespace camway::bench {

namespace {

using motion::CubicPath;

constexpr std::size_t kTrials = 6;      // starts of a range that have a trial
constexpr double kShareOfTrial = 0.08;  // of the time of a range
constexpr double kOtherShift = 0.3;     // of the cheapest start's: starts within it are the same

/// Largest shift in a range of one path from another. [Units: radians]
double shift_between(const Shot& shot, const CubicPath& a, const CubicPath& b,
                     const TimeRange& range) {
  constexpr int kTimes = 100;
  double largest_rad = 0.0;
  for (int i = 0; i <= kTimes; ++i) {
    const double share = static_cast<double>(i) / kTimes;
    const double time_s = std::lerp(range.begin_s, range.end_s, share);
    const motion::Pose one = a.pose(time_s);
    const motion::Pose other = b.pose(time_s);
    const double moved_m = (one.position - other.position).norm();
    largest_rad = std::max(largest_rad, moved_m / shot.closeness().viewing_distance_m +
                                            one.orientation.angularDistance(other.orientation));
  }
  return largest_rad;
}

/// The cheapest starts of a range that differ from one another, cheapest first.
std::vector<const CubicPath*> cheapest(const Shot& shot, const Goal& goal,
                                       std::span<const CubicPath> starts, const TimeRange& range) {
  std::vector<std::pair<double, const CubicPath*>> by_cost;
  for (const CubicPath& start : starts) {
    by_cost.emplace_back(goal.cost(start.around(range.begin_s, range.end_s)), &start);
  }
  std::ranges::stable_sort(by_cost, {}, &std::pair<double, const CubicPath*>::first);
  const double shift_rad =
      kOtherShift * shift_between(shot, *by_cost.front().second, shot.interpolated(), range);
  std::vector<const CubicPath*> list;
  for (const auto& [cost, start] : by_cost) {
    const bool is_other = std::ranges::all_of(list, [&, path = start](const CubicPath* known) {
      return shift_between(shot, *path, *known, range) > shift_rad;
    });
    if (is_other && list.size() < kTrials) list.push_back(start);
  }
  return list;
}

}  // namespace

CubicPath searched(const Shot& shot, const Goal& goal, const correction::FreeSpace& space,
                   std::span<const CubicPath> starts, const TimeRange& range,
                   const SearchEffort& effort) {
  std::vector<LocalSearch> searches;
  for (const CubicPath* start : cheapest(shot, goal, starts, range)) {
    LocalSearch& search = searches.emplace_back(shot, goal, space, *start, range, effort.seed);
    search.run(kShareOfTrial * effort.seconds);
  }
  LocalSearch& best = *std::ranges::min_element(searches, {}, &LocalSearch::cost);
  const auto trials = static_cast<double>(searches.size());
  best.run((1.0 - trials * kShareOfTrial) * effort.seconds);
  return best.path();
}

std::vector<CubicPath> free_with(const Shot& shot, std::span<const CubicPath> paths,
                                 double clearance_m) {
  const correction::FreeSpace space = shot.space_with(clearance_m);
  std::vector<CubicPath> kept;
  for (const CubicPath& path : paths) {
    const planning::PathCheck check = planning::check_path(
        space.query(), path.path(), base::Deadline::never(), base::Deadline::never());
    if (check.certificate.certified) kept.push_back(path);
  }
  return kept;
}

}  // namespace camway::bench
