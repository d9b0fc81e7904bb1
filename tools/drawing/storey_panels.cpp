// SPDX-License-Identifier: MIT
#include "tools/drawing/storey_panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/drawing/storeys.h"

namespace camway::draw {
namespace {

constexpr std::size_t kMostPanels = 6;
constexpr std::size_t kStride = 8;  // samples of a path for each one whose floor is searched

/// The storey of everything in a plan, as an index.
struct StoreySplit {
  std::vector<double> floors_m;
  std::vector<std::size_t> of_keyframe;
  std::vector<std::size_t> of_before;
  std::vector<std::size_t> of_after;
};

void add_points(const SampledPath& path, std::vector<geometry::Vec3>& points_W) {
  for (std::size_t i = 0; i < path.size(); i += kStride) {
    points_W.push_back(path[i].pose.position);
  }
}

/// Takes the storeys of the samples of `path` from `of_point`, beginning at `next`.
std::vector<std::size_t> of_samples(const SampledPath& path,
                                    const std::vector<std::size_t>& of_point, std::size_t& next) {
  std::vector<std::size_t> of_sample;
  for (std::size_t i = 0; i < path.size(); ++i) of_sample.push_back(of_point[next + i / kStride]);
  next += (path.size() + kStride - 1) / kStride;
  return of_sample;
}

/// Puts keyframes on the storey of the path at their times: on stairs, both are near a change.
void follow_path(const FloorPlan& plan, StoreySplit& split) {
  const SampledPath& path = plan.after.empty() ? plan.before : plan.after;
  const std::vector<std::size_t>& of_path = plan.after.empty() ? split.of_before : split.of_after;
  if (path.empty()) return;
  for (std::size_t i = 0; i < plan.keyframes.size(); ++i) {
    const auto at = &sample_at(path, plan.keyframes[i].time_s) - path.data();
    split.of_keyframe[i] = of_path[static_cast<std::size_t>(at)];
  }
}

StoreySplit split_by_storey(const FloorPlan& plan) {
  std::vector<geometry::Vec3> points_W;
  for (const motion::Keyframe& keyframe : plan.keyframes) {
    points_W.push_back(keyframe.pose.position);
  }
  add_points(plan.before, points_W);
  add_points(plan.after, points_W);
  VisitedStoreys visited = visited_storeys(plan.mesh, plan.up, points_W, plan.keyframes.size());
  StoreySplit split;
  split.floors_m = std::move(visited.floors_m);
  std::size_t next = plan.keyframes.size();
  split.of_keyframe.assign(visited.of_point.begin(),
                           visited.of_point.begin() + static_cast<std::ptrdiff_t>(next));
  split.of_before = of_samples(plan.before, visited.of_point, next);
  split.of_after = of_samples(plan.after, visited.of_point, next);
  follow_path(plan, split);
  return split;
}

/// Cuts a path into runs on the storey and off it, which meet.
PanelPath pieces_of(const SampledPath& path, const std::vector<std::size_t>& storeys,
                    std::size_t storey) {
  PanelPath pieces;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool is_here = storeys[i] == storey;
    std::vector<SampledPath>& runs = is_here ? pieces.here : pieces.elsewhere;
    const bool begins = i == 0 || is_here != (storeys[i - 1] == storey);
    if (begins) {
      runs.emplace_back();
      if (i > 0) (is_here ? pieces.elsewhere : pieces.here).back().push_back(path[i]);
    }
    runs.back().push_back(path[i]);
  }
  return pieces;
}

/// Adds the collisions of a path whose middles are on the storey.
void add_collisions(const SampledPath& path, const std::vector<std::size_t>& storeys,
                    const std::vector<collision::CollisionInterval>& intervals, bool remain,
                    std::size_t storey, Panel& panel) {
  if (path.empty()) return;
  for (const collision::CollisionInterval& interval : intervals) {
    const double middle_s = (interval.t_begin_s + interval.t_end_s) / 2;
    const auto at = static_cast<std::size_t>(&sample_at(path, middle_s) - path.data());
    if (storeys[at] != storey) continue;
    panel.collisions.push_back(
        {part_of(path, interval.t_begin_s, interval.t_end_s), middle_s, remain});
  }
}

/// Returns the keyframes on a storey, or some poses of the path where it has none.
std::vector<motion::Keyframe> seen_on(const FloorPlan& plan, const StoreySplit& split,
                                      std::size_t storey) {
  std::vector<motion::Keyframe> seen;
  for (std::size_t i = 0; i < plan.keyframes.size(); ++i) {
    if (split.of_keyframe[i] == storey) seen.push_back(plan.keyframes[i]);
  }
  const SampledPath& path = plan.after.empty() ? plan.before : plan.after;
  const std::vector<std::size_t>& of_path = plan.after.empty() ? split.of_before : split.of_after;
  for (std::size_t i = 0; i < path.size() && seen.empty(); ++i) {
    if (of_path[i] == storey) seen.push_back({path[i].time_s, path[i].pose});
  }
  return seen;
}

/// Returns the height for the section of a storey: the median height of the poses seen on it, where
/// doors are open or not below the lowest of them, and below the ceiling.
double cut_of_storey(const FloorPlan& plan, double floor_m,
                     const std::vector<motion::Keyframe>& seen) {
  constexpr double kLeast_m = 0.8;  // above the floor: cuts windows
  constexpr double kMost_m = 2.2;   // above the floor: lintels of doors are about as high
  constexpr double kBelowCeiling_m = 0.1;
  std::vector<double> heights_m;
  std::vector<geometry::Vec3> points_W;
  for (const motion::Keyframe& keyframe : seen) {
    points_W.push_back(keyframe.pose.position);
    heights_m.push_back(height_of(points_W.back(), plan.up));
  }
  std::ranges::sort(heights_m);
  const double most_m = std::max(floor_m + kMost_m, heights_m.front());
  const double height_m =
      std::clamp(heights_m[(heights_m.size() - 1) / 2], floor_m + kLeast_m, most_m);
  const std::optional<double> ceiling_m = ceiling_above(plan.mesh, plan.up, points_W, floor_m);
  return ceiling_m ? std::min(height_m, *ceiling_m - kBelowCeiling_m) : height_m;
}

FloorSection section_of_storey(const FloorPlan& plan, const StoreySplit& split,
                               std::size_t storey) {
  if (plan.cut_height_m && split.floors_m.size() < 2) {
    return cut_floor(plan.mesh, plan.up, *plan.cut_height_m);
  }
  if (split.floors_m.empty()) {
    return cut_floor(plan.mesh, plan.up, cut_height_m(plan.mesh, plan.up, plan.keyframes));
  }
  const double floor_m = split.floors_m[storey];
  const std::vector<motion::Keyframe> seen = seen_on(plan, split, storey);
  const double height_m = seen.empty() ? floor_m + kEyes_m : cut_of_storey(plan, floor_m, seen);
  return cut_floor(plan.mesh, plan.up, height_m, floor_m);
}

/// Returns the side of the barrier on which the keyframe of a number is; empty if no proof says.
std::string side_of(const std::optional<Barrier>& barrier, const std::string& number) {
  if (!barrier || number.empty()) return {};
  if (number == std::to_string(barrier->keyframe_inside)) return "inside";
  return number == std::to_string(barrier->keyframe_outside) ? "outside" : "";
}

Panel panel_of(const FloorPlan& plan, const StoreySplit& split, std::size_t storey) {
  Panel panel;
  panel.section = section_of_storey(plan, split, storey);
  std::vector<PlanPoint> places;
  for (const motion::Keyframe& keyframe : seen_on(plan, split, storey)) {
    places.push_back(to_plan(keyframe.pose.position, plan.up));
  }
  open_room_about(places, panel.section);
  const std::vector<std::string> numbers = keyframe_numbers(plan.keyframes);
  const bool is_level = are_level(plan.keyframes, plan.up);
  for (std::size_t i = 0; i < plan.keyframes.size(); ++i) {
    if (split.of_keyframe[i] != storey) continue;
    const motion::Keyframe& keyframe = plan.keyframes[i];
    const bool is_inserted = numbers[i].empty();
    const double height_m = height_of(keyframe.pose.position, plan.up);
    std::string remark = side_of(plan.barrier, numbers[i]);
    if (!is_level && !is_inserted) {
      remark += fmt::format("{}{:.2f} m", remark.empty() ? "" : ", ", height_m);
    }
    panel.keyframes.push_back({keyframe.pose, is_inserted, numbers[i], std::move(remark)});
  }
  panel.before = pieces_of(plan.before, split.of_before, storey);
  panel.after = pieces_of(plan.after, split.of_after, storey);
  for (const TimeRange& range : plan.corrected) {
    for (const SampledPath& piece : panel.after.here) {
      SampledPath part = part_of(piece, range.begin_s, range.end_s);
      if (part.size() > 1) panel.corrected.push_back(std::move(part));
    }
  }
  add_collisions(plan.before, split.of_before, plan.collisions, false, storey, panel);
  add_collisions(plan.after, split.of_after, plan.remaining_collisions, true, storey, panel);
  if (plan.barrier) panel.barrier = barrier_section(*plan.barrier, plan.up, panel.section);
  return panel;
}

}  // namespace

std::vector<std::string> keyframe_numbers(const std::vector<motion::Keyframe>& keyframes) {
  std::vector<std::string> numbers;
  std::size_t given = 0;
  for (const motion::Keyframe& keyframe : keyframes) {
    const bool is_inserted = keyframe.origin == motion::KeyframeOrigin::kInserted;
    numbers.push_back(is_inserted ? std::string() : std::to_string(given++));
  }
  return numbers;
}

bool are_level(const std::vector<motion::Keyframe>& keyframes, SceneUp up) {
  constexpr double kLevel_m = 0.05;
  Eigen::AlignedBox1d heights;
  for (const motion::Keyframe& keyframe : keyframes) {
    if (keyframe.origin == motion::KeyframeOrigin::kInserted) continue;
    heights.extend(Eigen::Matrix<double, 1, 1>(height_of(keyframe.pose.position, up)));
  }
  return heights.isEmpty() || heights.sizes()[0] <= kLevel_m;
}

std::vector<Panel> storey_panels(const FloorPlan& plan) {
  StoreySplit split = split_by_storey(plan);
  const std::size_t count = std::clamp<std::size_t>(split.floors_m.size(), 1, kMostPanels);
  std::vector<Panel> panels;
  for (std::size_t storey = 0; storey < count; ++storey) {
    panels.push_back(panel_of(plan, split, storey));
  }
  return panels;
}

const PathSample& sample_at(const SampledPath& path, double time_s) {
  return *std::min_element(path.begin(), path.end(), [&](const PathSample& a, const PathSample& b) {
    return std::abs(a.time_s - time_s) < std::abs(b.time_s - time_s);
  });
}

SampledPath part_of(const SampledPath& path, double begin_s, double end_s) {
  if (path.empty() || end_s < path.front().time_s || begin_s > path.back().time_s) return {};
  const auto first = &sample_at(path, begin_s) - path.data();
  const auto last = &sample_at(path, end_s) - path.data();
  return {path.begin() + first, path.begin() + last + 1};
}

}  // namespace camway::draw
