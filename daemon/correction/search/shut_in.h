// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "daemon/geometry/types.h"

namespace camway::correction {

/// A keyframe from which no way out was found, for a ball much smaller than the body. All that the
/// ball can reach was looked at, as far as searches see: it is no proof.
struct ShutIn {
  std::size_t keyframe = 0;
  geometry::Box region_W;  ///< about all places of the middle of the body that were reached

  [[nodiscard]] bool holds(const geometry::Vec3& point_W) const {
    return region_W.contains(point_W);
  }
};

}  // namespace camway::correction
