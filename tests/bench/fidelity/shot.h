// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "daemon/collision/query.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/spline/cubic_path.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/bench/request_set.h"

namespace camway::bench {

/// A request that is corrected in several ways, its path as interpolated, and the scale by which
/// corrections of it are compared.
///
/// The request keeps its scene, camera, keyframes, required clearance, bounds and viewing distance.
/// All other options are the defaults, so that every way has the same camera and the same times.
/// Times count from the first keyframe.
///
/// Not thread-safe.
class Shot {
 public:
  /// Refers to `snapshot` and `request`, which must outlive it. `deadline_s`: of each plan.
  Shot(const scene::Snapshot& snapshot, const BenchRequest& request, double deadline_s);
  Shot(const Shot&) = delete;
  Shot& operator=(const Shot&) = delete;

  [[nodiscard]] const scene::Snapshot& snapshot() const { return snapshot_; }
  [[nodiscard]] const BenchRequest& request() const { return request_; }
  /// The request as it is planned.
  [[nodiscard]] const planning::PlanRequest& plan() const { return plan_; }
  [[nodiscard]] const motion::CubicPath& interpolated() const { return interpolated_; }
  /// The path as interpolated, as segments.
  [[nodiscard]] const motion::Path& original() const { return original_; }
  [[nodiscard]] const correction::Closeness& closeness() const { return space_.closeness(); }
  [[nodiscard]] const correction::FreeSpace& space() const { return space_; }

  /// Number of collisions of the path as interpolated.
  [[nodiscard]] std::size_t collisions() const { return collisions_; }

  /// Returns the cost of the default objective: `correction::closeness_cost`, with the scale that
  /// planning uses. [Units: radian seconds]
  [[nodiscard]] double cost(const motion::CubicPath& path) const;

  /// Returns the collisions of a path, or its certificate, as answers have them.
  [[nodiscard]] planning::PathCheck check(const motion::Path& path) const;

  /// Returns the space in which a body keeps `clearance_m` from the scene, instead of the required
  /// clearance. It refers to this object, which must outlive it. [Limit: 0 <= clearance_m]
  [[nodiscard]] correction::FreeSpace space_with(double clearance_m) const;

  /// Returns the certified clearance of a path that is proved free with the required clearance;
  /// nothing if it is not proved free. [Units: metres]
  [[nodiscard]] std::optional<double> certified_clearance_m(const motion::Path& path) const;

 private:
  const scene::Snapshot& snapshot_;
  const BenchRequest& request_;
  const planning::PlanRequest plan_;
  const motion::Body body_;
  const motion::CubicPath interpolated_;
  const motion::Path original_;
  const collision::Query query_;
  const correction::FreeSpace space_;
  const std::size_t collisions_;
};

}  // namespace camway::bench
