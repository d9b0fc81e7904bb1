// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/best_known.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "tests/bench/fidelity/assembly.h"
#include "tests/bench/fidelity/changed_ranges.h"
#include "tests/bench/fidelity/goal.h"
#include "tests/bench/fidelity/range_search.h"
#include "tests/bench/measure.h"

namespace camway::bench {

namespace {

using motion::CubicPath;
using planning::PlanOptions;

constexpr double kMarginOfSearch = 0.5;   // of the duration of a range, on either side
constexpr double kLittleTurn_rad = 0.17;  // ten degrees
constexpr double kLongestPlan_s = 2.0;    // of an other answer
constexpr double kDearStart = 3.0;        // times the least cost: such starts are left out
constexpr double kMarginOfBox = 1.05;     // of the body's radius

std::vector<PlanOptions> other_options(const Shot& shot) {
  PlanOptions own = shot.plan().options;
  own.deadline_s = std::min(own.deadline_s, kLongestPlan_s);
  std::vector<PlanOptions> list;
  const auto add = [&](const auto& change) { change(list.emplace_back(own)); };
  add([](PlanOptions& o) { o.orientation.rule = correction::OrientationRule::kKeep; });
  add([](PlanOptions& o) { o.orientation.max_turn_rad = kLittleTurn_rad; });
  // Another distance weighs moves and turns otherwise.
  for (const double factor : {0.3, 3.0}) {
    const double distance_m = factor * shot.closeness().viewing_distance_m;
    add([&](PlanOptions& o) { o.viewing_distance_m = distance_m; });
  }
  for (const std::uint64_t seed : {2U, 3U}) {
    add([&](PlanOptions& o) { o.seed = seed; });
  }
  const double margin_m = kMarginOfBox * shot.space().ball_radius_m();
  geometry::Box box;
  for (const motion::Keyframe& keyframe : shot.plan().keyframes) {
    box.extend(shot.space().center_W(keyframe.pose));
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    add([&](PlanOptions& o) {
      o.bounds.min_W[axis] = std::max(o.bounds.min_W[axis], box.min()[axis] - margin_m);
    });
    add([&](PlanOptions& o) {
      o.bounds.max_W[axis] = std::min(o.bounds.max_W[axis], box.max()[axis] + margin_m);
    });
  }
  return list;
}

/// The starts without those that cost much more than the cheapest: they change long parts of the
/// path, which would then be searched as one.
std::vector<CubicPath> without_dear(const Shot& shot, std::span<const CubicPath> starts) {
  double least = std::numeric_limits<double>::infinity();
  for (const CubicPath& start : starts) least = std::min(least, shot.cost(start));
  std::vector<CubicPath> kept;
  std::ranges::copy_if(starts, std::back_inserter(kept), [&](const CubicPath& start) {
    return shot.cost(start) <= kDearStart * least;
  });
  return kept;
}

/// The ranges in which some start differs from the path as interpolated.
std::vector<TimeRange> ranges_of(const Shot& shot, std::span<const CubicPath> starts) {
  std::vector<TimeRange> all;
  for (const CubicPath& start : starts) {
    std::ranges::copy(changed_ranges(start, shot.interpolated()), std::back_inserter(all));
  }
  return joined(std::move(all));
}

/// A range, with time on either side where nothing else changes.
TimeRange widened(const std::vector<TimeRange>& ranges, std::size_t i, const CubicPath& path) {
  const TimeRange& range = ranges[i];
  const double margin_s = kMarginOfSearch * (range.end_s - range.begin_s);
  const double before_s = i == 0 ? path.begin_s() : 0.5 * (ranges[i - 1].end_s + range.begin_s);
  const double after_s =
      i + 1 == ranges.size() ? path.end_s() : 0.5 * (range.end_s + ranges[i + 1].begin_s);
  return {std::max(before_s, range.begin_s - margin_s), std::min(after_s, range.end_s + margin_s)};
}

/// Searches each range by itself, and joins the results to one path.
CubicPath searched_everywhere(const Shot& shot, std::span<const CubicPath> starts,
                              const SearchEffort& effort) {
  const correction::FreeSpace space = shot.space_with(effort.clearance_m + kSlack_m);
  const Goal goal = closeness_goal(shot);
  const std::vector<TimeRange> ranges = ranges_of(shot, starts);
  SearchEffort share = effort;
  share.seconds /= static_cast<double>(ranges.size());
  std::vector<CubicPath> paths;
  std::vector<TimeRange> wide;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    wide.push_back(widened(ranges, i, shot.interpolated()));
    paths.push_back(searched(shot, goal, space, starts, wide.back(), share));
  }
  std::vector<PathPart> parts;
  for (std::size_t i = 0; i < paths.size(); ++i) parts.push_back({wide[i], &paths[i]});
  return assembled(shot.interpolated(), shot.plan().keyframes, parts);
}

}  // namespace

std::vector<Answer> other_answers(const Shot& shot) {
  std::vector<Answer> answers;
  for (const PlanOptions& options : other_options(shot)) {
    Answer answer = planned(shot, options);
    if (answer.is_proved()) answers.push_back(std::move(answer));
  }
  return answers;
}

std::optional<Answer> best_known(const Shot& shot, std::span<const CubicPath> starts,
                                 const SearchEffort& effort) {
  const double begin_s = thread_seconds();
  std::vector<CubicPath> found = free_with(shot, starts, effort.clearance_m);
  const std::vector<CubicPath> searchable =
      without_dear(shot, free_with(shot, found, effort.clearance_m + kSlack_m));
  if (effort.seconds > 0.0 && !ranges_of(shot, searchable).empty()) {
    const CubicPath path = searched_everywhere(shot, searchable, effort);
    std::ranges::move(free_with(shot, std::span(&path, 1), effort.clearance_m),
                      std::back_inserter(found));
  }
  if (found.empty()) return std::nullopt;
  const auto cost = [&](const CubicPath& path) { return shot.cost(path); };
  Answer best{.status = "found"};
  best.cubic = *std::ranges::min_element(found, {}, cost);
  best.path = best.cubic.path();
  best.clearance_m = shot.certified_clearance_m(best.path);
  best.inserted = best.cubic.pieces.size() - shot.interpolated().pieces.size();
  best.time_s = thread_seconds() - begin_s;
  return best;
}

}  // namespace camway::bench
