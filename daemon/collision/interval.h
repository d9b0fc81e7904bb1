// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/geometry/types.h"

namespace camway::collision {

/// Where a collision was seen: the deepest contact at about the middle of its interval.
struct Witness {
  double time_s = 0.0;
  /// Of the scene's mesh, or a side of the bounds (`Obstacles::is_side`).
  std::uint32_t triangle = 0;
  std::uint32_t feature = 0;  ///< of the body, see `motion::Body::feature_name`
  /// Estimate of how far the body would have to move there to be free of that triangle (and keep
  /// the required clearance from it), or inside. Not part of any proof.
  double depth_m = 0.0;
  geometry::Vec3 point_W = geometry::Vec3::Zero();  ///< of the triangle, nearest to the body

  bool operator==(const Witness&) const = default;
};

/// A maximal stretch of the path in which the body collides with the scene, comes nearer than the
/// required clearance, or is not all within the bounds. Closed; `t_begin_s == t_end_s` for a touch
/// at one instant.
struct CollisionInterval {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  /// Nothing where nobody looked for it, or where only undecided stretches were seen and the scene
  /// is nowhere near.
  std::optional<Witness> witness = std::nullopt;

  bool operator==(const CollisionInterval&) const = default;
};

}  // namespace camway::collision
