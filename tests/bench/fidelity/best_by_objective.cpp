// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/best_by_objective.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/orientation_rule.h"
#include "tests/bench/fidelity/answers.h"
#include "tests/bench/fidelity/assembly.h"
#include "tests/bench/fidelity/goal.h"
#include "tests/bench/fidelity/objective_value.h"

namespace camway::bench {

namespace {

using correction::Objective;
using motion::CubicPath;
using motion::Keyframe;
using planning::PlanOptions;

constexpr double kShares[] = {0.95, 0.75, 0.55, 0.4, 0.28, 0.2};  // of the gap of the keyframes
constexpr std::uint64_t kSeedsOfStarts[] = {2, 3};
constexpr double kLongestPlanOfStart_s = 2.0;  // of a start
constexpr double kKept = 0.95;    // of the gap of the closest path, which is known by a lower bound
constexpr double kFarther = 2.0;  // times the shift of the closest path and of the gap

bool overlap(const TimeRange& a, const TimeRange& b) {
  return a.begin_s < b.end_s && b.begin_s < a.end_s;
}

bool is_within(const TimeRange& inner, const TimeRange& outer) {
  return outer.begin_s <= inner.begin_s && inner.end_s <= outer.end_s;
}

/// The intervals between keyframes.
std::vector<TimeRange> legs_of(const Shot& shot) {
  const std::vector<Keyframe>& given = shot.plan().keyframes;
  std::vector<TimeRange> legs;
  for (std::size_t i = 1; i < given.size(); ++i) {
    legs.push_back({given[i - 1].time_s, given[i].time_s});
  }
  return legs;
}

/// The path that is `part` in the range and `whole` elsewhere; nothing if `part` changes something
/// across an end of the range.
std::optional<CubicPath> cut_to(const Shot& shot, const TimeRange& range, const CubicPath& part,
                                const CubicPath& whole) {
  std::vector<PathPart> parts;
  for (const TimeRange& changed : changed_ranges(part, shot.interpolated())) {
    if (!overlap(changed, range)) continue;
    if (!is_within(changed, range)) return std::nullopt;
  }
  if (range.begin_s > whole.begin_s()) parts.push_back({{whole.begin_s(), range.begin_s}, &whole});
  parts.push_back({range, &part});
  if (range.end_s < whole.end_s()) parts.push_back({{range.end_s, whole.end_s()}, &whole});
  return assembled(shot.interpolated(), shot.plan().keyframes, parts);
}

double largest_turn_rad(const Shot& shot, const CubicPath& path, const TimeRange& leg) {
  constexpr int kTimes = 100;
  double largest_rad = 0.0;
  for (int i = 0; i <= kTimes; ++i) {
    const double time_s = std::lerp(leg.begin_s, leg.end_s, static_cast<double>(i) / kTimes);
    const geometry::Quat before = shot.interpolated().pose(time_s).orientation;
    largest_rad = std::max(largest_rad, before.angularDistance(path.pose(time_s).orientation));
  }
  return largest_rad;
}

bool turns_further(const Shot& shot, const CubicPath& path, const CubicPath& closest) {
  return std::ranges::any_of(legs_of(shot), [&](const TimeRange& leg) {
    return largest_turn_rad(shot, path, leg) >
           largest_turn_rad(shot, closest, leg) + correction::kOrientationAllowance_rad;
  });
}

double shift_rad(const Shot& shot, const CubicPath& path, const TimeRange& range) {
  return correction::shift_of(path.around(range.begin_s, range.end_s), shot.interpolated(),
                              shot.closeness())
      .largest_rad;
}

bool leads_too_far(const Shot& shot, const CubicPath& path, const CubicPath& closest,
                   const TimeRange& range) {
  const double gap_rad = sufficient_gap_m(shot) / shot.closeness().viewing_distance_m;
  return shift_rad(shot, path, range) > kFarther * (shift_rad(shot, closest, range) + gap_rad);
}

/// The compared ranges within a searched one.
std::vector<TimeRange> compared_in(const Extent& extent, const TimeRange& range) {
  std::vector<TimeRange> within;
  std::ranges::copy_if(extent.compared, std::back_inserter(within),
                       [&](const TimeRange& compared) { return is_within(compared, range); });
  return within;
}

/// The least gap of the keyframes of ranges, at most the sufficient one: no path has more.
double keyframes_gap_m(const Shot& shot, std::span<const TimeRange> ranges) {
  collision::Query query = shot.space().query();
  query.options.clearance_m = 0.0;
  query.obstacles.bounds = {};
  correction::FreeSpace space(query);
  double least_m = sufficient_gap_m(shot);
  for (const Keyframe& keyframe : shot.plan().keyframes) {
    const bool counts = std::ranges::any_of(ranges, [&](const TimeRange& range) {
      return range.begin_s <= keyframe.time_s && keyframe.time_s <= range.end_s;
    });
    if (counts) least_m = std::min(least_m, space.gap_m(keyframe.pose, least_m));
  }
  return least_m;
}

/// Options of the plans whose answers are starts, in a range of which this is compared.
std::vector<PlanOptions> options_of_starts(Objective objective, const Shot& shot,
                                           std::span<const TimeRange> compared) {
  PlanOptions own = shot.plan().options;
  own.deadline_s = std::min(own.deadline_s, kLongestPlanOfStart_s);
  std::vector<PlanOptions> list;
  for (const std::uint64_t seed : kSeedsOfStarts) {
    list.push_back(own);
    list.back().objective = objective;
    list.back().seed = seed;
  }
  if (objective != Objective::kSafest) return list;
  const double gap_m = keyframes_gap_m(shot, compared);
  for (const double share : kShares) {
    if (share * gap_m <= own.clearance_m) continue;
    list.push_back(own);
    list.back().clearance_m = share * gap_m;
  }
  return list;
}

/// The best path in a range, of starts that differ there alone.
CubicPath best_in(Objective objective, const Shot& shot, const std::vector<CubicPath>& starts,
                  const TimeRange& range, std::span<const TimeRange> compared,
                  const SearchEffort& effort) {
  const double clearance_m = std::max(effort.clearance_m, shot.plan().options.clearance_m);
  std::vector<CubicPath> known = starts;
  const std::vector<Goal> goals = goals_of(objective, shot);
  const correction::FreeSpace space = shot.space_with(clearance_m + kSlack_m);
  SearchEffort share = effort;
  share.seconds /= static_cast<double>(goals.size());
  for (const Goal& goal : goals) {
    const std::vector<CubicPath> searchable = free_with(shot, known, clearance_m + kSlack_m);
    if (searchable.empty() || effort.seconds <= 0.0) break;
    const CubicPath found = searched(shot, goal, space, searchable, range, share);
    std::ranges::move(free_with(shot, std::span(&found, 1), clearance_m),
                      std::back_inserter(known));
  }
  std::vector<double> values;
  for (const CubicPath& path : known) {
    values.push_back(value_of(objective, shot, path, compared));
  }
  const auto best = std::ranges::min_element(
      values, [&](double a, double b) { return is_worse(objective, b, a); });
  return known[static_cast<std::size_t>(best - values.begin())];
}

}  // namespace

std::vector<TimeRange> compared_ranges(const Shot& shot, std::span<const CubicPath> paths) {
  std::vector<TimeRange> all;
  for (const CubicPath& path : paths) {
    for (const TimeRange& changed : changed_ranges(path, shot.interpolated())) {
      std::ranges::copy_if(legs_of(shot), std::back_inserter(all),
                           [&](const TimeRange& leg) { return overlap(leg, changed); });
    }
  }
  return joined(std::move(all));
}

Extent extent_of(Objective objective, const Shot& shot, const CubicPath& closest,
                 const CubicPath& answer) {
  const std::array both{closest, answer};
  Extent extent{compared_ranges(shot, both), {}};
  extent.compared = objective == Objective::kSafest
                        ? compared_ranges(shot, std::span(both).first(1))
                        : extent.searched;
  // Where the answer alone is changed, there is nothing to compare.
  std::erase_if(extent.searched, [&](const TimeRange& searched) {
    return std::ranges::none_of(
        extent.compared, [&](const TimeRange& compared) { return is_within(compared, searched); });
  });
  return extent;
}

std::vector<CubicPath> starts_of(Objective objective, const Shot& shot, const CubicPath& closest,
                                 const CubicPath& answer, const Extent& extent) {
  std::vector<CubicPath> starts = {closest, answer};
  for (const TimeRange& range : extent.searched) {
    const std::vector<TimeRange> compared = compared_in(extent, range);
    for (const PlanOptions& options : options_of_starts(objective, shot, compared)) {
      const Answer other = planned(shot, options);
      if (other.cubic.pieces.empty()) continue;
      const std::optional<CubicPath> cut = cut_to(shot, range, other.cubic, closest);
      if (!cut || turns_further(shot, *cut, closest)) continue;
      if (objective == Objective::kSafest && leads_too_far(shot, *cut, closest, range)) continue;
      std::ranges::move(free_with(shot, std::span(&*cut, 1), shot.plan().options.clearance_m),
                        std::back_inserter(starts));
    }
  }
  return starts;
}

double kept_clearance_m(Objective objective, const Shot& shot, const CubicPath& closest,
                        std::span<const TimeRange> ranges) {
  const double required_m = shot.plan().options.clearance_m;
  if (objective == Objective::kSafest) return required_m;
  const double tight_m = required_m + kTightGap * shot.space().ball_radius_m();
  const double least_m = std::min(tight_m, kKept * proved_clearance_m(shot, closest, ranges));
  return std::max(required_m, least_m - kSlack_m);
}

CubicPath best_by_objective(Objective objective, const Shot& shot,
                            std::span<const CubicPath> starts, const Extent& extent,
                            const SearchEffort& effort) {
  CubicPath best = starts.front();
  SearchEffort share = effort;
  share.seconds /= static_cast<double>(extent.searched.size());
  for (const TimeRange& range : extent.searched) {
    std::vector<CubicPath> cut = {best};
    for (const CubicPath& start : starts.subspan(1)) {
      std::optional<CubicPath> other = cut_to(shot, range, start, best);
      if (other) cut.push_back(*std::move(other));
    }
    // The same spline through other joints differs by rounding, which may cost a proof.
    cut = free_with(shot, cut, shot.plan().options.clearance_m);
    if (!cut.empty())
      best = best_in(objective, shot, cut, range, compared_in(extent, range), share);
  }
  return best;
}

bool is_worse(Objective objective, double value, double other, double by_share) {
  return objective == Objective::kSafest ? value < (1.0 - by_share) * other
                                         : value > (1.0 + by_share) * other;
}

}  // namespace camway::bench
