// SPDX-License-Identifier: MIT
#pragma once

namespace camway::collision {

/// A maximal stretch of the path in which the near quadrilateral collides with the scene. Closed;
/// `t_begin_s == t_end_s` for a touch at one instant.
struct CollisionInterval {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;

  bool operator==(const CollisionInterval&) const = default;
};

}  // namespace camway::collision
