// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "daemon/geometry/types.h"

namespace camway::correction {

/// A keyframe from which a search found no way out, even for a ball much smaller than the body. It
/// is not a proof.
struct ShutIn {
  std::size_t keyframe = 0;
  geometry::Box region_W;  ///< about all points that the body's centre can reach
  double unsure_m = 0.0;   ///< how much too small the region may be
  /// Whether the search looked at everything that the ball can reach. If not, the region has only
  /// what was reached before the search ended at its limit.
  bool is_complete = true;

  /// Returns false only for points outside of a region that is complete.
  [[nodiscard]] bool may_hold(const geometry::Vec3& point_W) const {
    return !is_complete || region_W.exteriorDistance(point_W) <= unsure_m;
  }
};

}  // namespace camway::correction
