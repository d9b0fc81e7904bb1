// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "daemon/motion/body/body.h"
#include "daemon/motion/path/keyframe.h"

namespace camway::testing {

/// Returns the largest distance that a point of the body moves from one pose to the other. It is
/// that of a vertex, since a point's move is an affine function of the point. Requires a body
/// without a ball.
inline double farthest_move_m(const motion::Body& body, const motion::Pose& from,
                              const motion::Pose& to) {
  double farthest_m = 0.0;
  for (const geometry::Triangle& triangle : body.triangles_C()) {
    for (const geometry::Vec3& vertex_C : triangle) {
      const geometry::Vec3 moved =
          (to.position + to.orientation * vertex_C) - (from.position + from.orientation * vertex_C);
      farthest_m = std::max(farthest_m, moved.norm());
    }
  }
  return farthest_m;
}

}  // namespace camway::testing
