// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/detect.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/path.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"
#include "daemon/scene/snapshot/scene_difference.h"

namespace camway::planning {

/// A path that was proved free, with the data to check quickly whether it is still free after a
/// change of its scene. Immutable. Thread-safe.
///
/// Proof: the scene after a change consists of the part that stayed and the part that was added. A
/// path that was proved free in the earlier scene is free of the part that stayed, since removing
/// triangles brings no triangle and no solid nearer. So the path is free in the new scene if it is
/// free of the added part. The boxes of the added part hold its triangles and its inside. The eye
/// on a segment lies in the convex hull of its four control points, in exact arithmetic, and every
/// body point is within `Body::radius_m` plus the ball's radius of the eye. So the body stays in
/// the box of the control points grown by these, by `Body::slack_m` and the required clearance, all
/// rounded up. A segment whose grown box does not meet the box of an added object is free of that
/// object. Every other segment has to be proved free of the added part alone, by
/// `collision::any_collision`. The path stays within the bounds as long as they are the same. If
/// the bounds of the scene change, nothing is known. Smooth surfaces of the scene are kept at the
/// distance of its `surface_error_m` from their triangles; as long as that does not grow, what
/// stayed is kept at the same distance. If it grows, nothing is known.
class WatchedPath {
 public:
  /// Requires segments with increasing times.
  WatchedPath(motion::Path path, motion::Body body, const collision::DetectOptions& detect,
              const geometry::Bounds& bounds = {});

  /// Returns the path that `result` proves free for `request`; nothing if it has no proved path.
  static std::optional<WatchedPath> of(const PlanRequest& request, const PlanResult& result);

  /// Returns the path of `request` as interpolated, if it collided and `result` has a corrected
  /// path; nothing otherwise. Repaired keyframes have the poses of `result`. The body has the size
  /// of the request.
  static std::optional<WatchedPath> as_interpolated(const PlanRequest& request,
                                                    const PlanResult& result);

  [[nodiscard]] const motion::Path& path() const { return path_; }
  [[nodiscard]] const motion::Body& body() const { return body_; }
  [[nodiscard]] const collision::DetectOptions& detect() const { return detect_; }
  [[nodiscard]] const geometry::Bounds& bounds() const { return bounds_; }

  /// Returns whether the change can affect the path. If not, everything that was known of the path
  /// still holds.
  [[nodiscard]] bool may_meet(const scene::SceneDifference& change) const;

  /// Returns true if a path that was free before is proved free after. If false, nothing is proved.
  [[nodiscard]] bool stays_free(const scene::SceneDifference& change,
                                const base::Deadline& deadline) const;

  /// Returns where the path collides, or leaves the bounds of its request or of `obstacles`,
  /// searched from scratch by `collision::detect_collisions`. Returns all of it if the deadline
  /// struck.
  [[nodiscard]] std::vector<collision::CollisionInterval> collisions(
      const collision::Obstacles& obstacles, const base::Deadline& deadline) const;

  /// Returns the whole path, as the collision of a path of which nothing is known.
  [[nodiscard]] collision::CollisionInterval everywhere() const {
    return {path_.begin_s(), path_.end_s()};
  }

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  motion::Path path_;
  motion::Body body_;
  collision::DetectOptions detect_;
  geometry::Bounds bounds_;           ///< bounds of the request
  std::vector<geometry::Box> swept_;  ///< box of each segment; nothing beyond is too near
  geometry::Box all_swept_;
};

}  // namespace camway::planning
