// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "daemon/geometry/types.h"

namespace camway::correction {

/// A keyframe from which no way out was found, for a ball much smaller than the body. All that the
/// ball can reach was looked at, as far as searches see: it is no proof.
struct ShutIn {
  std::size_t keyframe = 0;
  geometry::Box region_W;  ///< about all that the middle of the body reached
  double unsure_m = 0.0;   ///< by how much that may be too small

  /// False only for points that are not in the region.
  [[nodiscard]] bool may_hold(const geometry::Vec3& point_W) const {
    return region_W.exteriorDistance(point_W) <= unsure_m;
  }
};

}  // namespace camway::correction
