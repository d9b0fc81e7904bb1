// SPDX-License-Identifier: MIT
#include "daemon/planning/watched_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/planning/stages/keyframe_times.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/planning/stages/prepare.h"

namespace camway::planning {
namespace {

using geometry::Box;
using geometry::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Three sums of non-negative numbers, each of which rounds by half an epsilon at most.
constexpr double kRoundUp = 1.0 + 4.0 * std::numeric_limits<double>::epsilon();

/// Returns a box outside of which nothing is nearer than `margin_m` to the hull of the control
/// points; all of space if a number is not finite.
Box swept_box(const motion::Segment& segment, double margin_m) {
  Box box;
  bool finite = std::isfinite(margin_m);
  for (const Vec3& point : segment.position) {
    finite = finite && point.allFinite();
    box.extend(point);
  }
  if (!finite) return Box(Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity));
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] = std::nextafter(box.min()[axis] - margin_m, -kInfinity);
    box.max()[axis] = std::nextafter(box.max()[axis] + margin_m, kInfinity);
  }
  return box;
}

bool meets_added(const Box& swept, const scene::SceneDifference& change) {
  const double reach_m = change.surface_error_m * kRoundUp;
  const Box grown(swept.min().array() - reach_m, swept.max().array() + reach_m);
  return std::ranges::any_of(change.added, [&](const Box& box) { return grown.intersects(box); });
}

/// Whether all that was known of a path may be wrong, wherever it is.
bool changes_all(const scene::SceneDifference& change) {
  return change.other_bounds || change.is_coarser;
}

}  // namespace

WatchedPath::WatchedPath(motion::Path path, motion::Body body,
                         const collision::DetectOptions& detect, const geometry::Bounds& bounds)
    : path_(std::move(path)), body_(std::move(body)), detect_(detect), bounds_(bounds) {
  const double margin_m =
      (body_.radius_m() + body_.ball_radius_m() + body_.slack_m() + detect_.clearance_m) * kRoundUp;
  swept_.reserve(path_.segments().size());
  for (const motion::Segment& segment : path_.segments()) {
    swept_.push_back(swept_box(segment, margin_m));
    all_swept_.extend(swept_.back());
  }
}

std::optional<WatchedPath> WatchedPath::of(const PlanRequest& request, const PlanResult& result) {
  if (!result.certificate.certified || result.path.empty()) return std::nullopt;
  base::Result<motion::Body> body = motion::Body::make(body_shape(request, result.near_scale));
  if (!body) return std::nullopt;
  return WatchedPath(result.path, *std::move(body), detect_options(request.options),
                     request.options.bounds);
}

std::optional<WatchedPath> WatchedPath::as_interpolated(const PlanRequest& request,
                                                        const PlanResult& result) {
  if (!result.certificate.certified || result.collisions.empty()) return std::nullopt;
  base::Result<motion::Body> body = motion::Body::make(body_shape(request));
  if (!body) return std::nullopt;
  PreparedKeyframes prepared = prepared_keyframes(request);
  for (const KeyframeFault& fault : result.keyframe_faults) {
    if (fault.free_pose) prepared.keyframes[fault.keyframe].pose = *fault.free_pose;
  }
  const motion::CubicPath path = interpolated_path(request, prepared.keyframes, prepared.origin);
  return WatchedPath(to_sent_times(prepared.origin, path.path()), *std::move(body),
                     detect_options(request.options), request.options.bounds);
}

bool WatchedPath::may_meet(const scene::SceneDifference& change) const {
  return changes_all(change) || meets_added(all_swept_, change) ||
         std::ranges::any_of(change.removed,
                             [&](const Box& box) { return all_swept_.intersects(box); });
}

bool WatchedPath::stays_free(const scene::SceneDifference& change,
                             const base::Deadline& deadline) const {
  if (changes_all(change)) return false;
  if (!meets_added(all_swept_, change)) return true;
  collision::Obstacles added(change.index);
  added.solids = change.solids.get();
  added.surface_error_m = change.surface_error_m;
  for (std::size_t i = 0; i < swept_.size();) {
    if (!meets_added(swept_[i], change)) {
      ++i;
      continue;
    }
    std::vector<motion::Segment> near;
    for (; i < swept_.size() && meets_added(swept_[i], change); ++i) {
      near.push_back(path_.segments()[i]);
    }
    const motion::Path part(std::move(near));
    const collision::FirstCollision found = collision::any_collision(
        {added, body_, detect_}, part, part.begin_s(), part.end_s(), deadline);
    if (!found.decided || found.interval) return false;
  }
  return true;
}

std::vector<collision::CollisionInterval> WatchedPath::collisions(
    const collision::Obstacles& obstacles, const base::Deadline& deadline) const {
  auto found = collision::detect_collisions({obstacles.within(bounds_), body_, detect_}, path_,
                                            path_.begin_s(), path_.end_s(), deadline);
  return found ? std::move(*found) : std::vector{everywhere()};
}

std::size_t WatchedPath::memory_bytes() const {
  return sizeof(WatchedPath) + swept_.size() * (sizeof(motion::Segment) + sizeof(Box)) +
         body_.memory_bytes();
}

}  // namespace camway::planning
