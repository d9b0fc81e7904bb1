// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/collision/detect.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/path.h"
#include "daemon/planning/request.h"
#include "daemon/planning/result.h"
#include "daemon/scene/snapshot/scene_difference.h"

namespace camway::planning {

/// A path that was proved free of collision once, and what it takes to tell quickly whether it
/// still is when its scene has changed. Immutable.
///
/// The proof: the scene after a change is what stayed, and what was added. A path that was proved
/// free of the scene before is proved free of what stayed, since taking triangles away brings none
/// nearer, nor solids. So it is free in the new scene if it is free of what was added, whose box
/// holds its triangles and its inside. A segment's eye lies in
/// the convex hull of its four control points, in exact arithmetic, and every point of the body
/// within `Body::radius_m` and the ball's radius of the eye: so the body stays in the box of the
/// control points, grown by these, by `Body::slack_m` and the required clearance, all rounded up. A
/// segment whose grown box does not meet the box of an added object is free of it; of all other
/// segments `collision::detect_collisions` has to prove it against what was added alone. Within the
/// bounds it stays while these are the same; where those of the scene are others, nothing is known.
class WatchedPath {
 public:
  /// Precondition: segments with increasing times.
  WatchedPath(motion::Path path, motion::Body body, const collision::DetectOptions& detect,
              const geometry::Bounds& bounds = {});

  /// What `result` proves for the body that `request` asked for; nothing if it proves nothing.
  static std::optional<WatchedPath> of(const PlanRequest& request, const PlanResult& result);

  [[nodiscard]] const motion::Path& path() const { return path_; }

  /// Whether the change can be anything to the path at all: if not, what was known of it holds on.
  [[nodiscard]] bool may_meet(const scene::SceneDifference& change) const;

  /// Proved: a path that was free before the change is free after it. False proves nothing.
  [[nodiscard]] bool stays_free(const scene::SceneDifference& change,
                                const collision::Deadline& deadline) const;

  /// Where it collides, or leaves the bounds of its request or of `obstacles`, from scratch, as
  /// `collision::detect_collisions` says. All of it where the deadline struck.
  [[nodiscard]] std::vector<collision::CollisionInterval> collisions(
      const collision::Obstacles& obstacles, const collision::Deadline& deadline) const;

  /// Where nothing is known of it.
  [[nodiscard]] collision::CollisionInterval everywhere() const {
    return {path_.begin_s(), path_.end_s()};
  }

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  motion::Path path_;
  motion::Body body_;
  collision::DetectOptions detect_;
  geometry::Bounds bounds_;           ///< of the request
  std::vector<geometry::Box> swept_;  ///< of each segment: nothing outside can be too near
  geometry::Box all_swept_;
};

}  // namespace camway::planning
