// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "daemon/geometry/types.h"

namespace camway::correction {

/// A keyframe from which a search found no way out, even for a ball much smaller than the body.
/// This is no proof.
struct ShutIn {
  std::size_t keyframe = 0;
  geometry::Box region_W;  ///< a box about the points that the body's centre can reach
  double unsure_m = 0.0;   ///< by how much the box may be too small
  /// Whether the search visited all points that the ball can reach. Otherwise the box holds the
  /// points reached before the search ended at its limit.
  bool is_complete = true;

  /// Returns false only for points outside of a region that is complete.
  [[nodiscard]] bool may_hold(const geometry::Vec3& point_W) const {
    return !is_complete || region_W.exteriorDistance(point_W) <= unsure_m;
  }
};

}  // namespace camway::correction
