// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/geometry/types.h"

namespace camway::collision {

/// Where a collision was seen: the deepest contact at about the middle of its interval.
struct Witness {
  double time_s = 0.0;
  std::uint32_t triangle = 0;  ///< of the scene's mesh
  std::uint32_t feature = 0;   ///< of the body, see `motion::Body::feature_name`
  /// Estimate of how far the body would have to move there to be free of that triangle (and keep
  /// the required clearance from it). Not part of any proof.
  double depth_m = 0.0;
  geometry::Vec3 point_W = geometry::Vec3::Zero();  ///< of the triangle, nearest to the body

  bool operator==(const Witness&) const = default;
};

/// A maximal stretch of the path in which the body collides with the scene, or comes nearer than
/// the required clearance. Closed; `t_begin_s == t_end_s` for a touch at one instant.
struct CollisionInterval {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  /// Nothing where nobody looked for it, or where only undecided stretches were seen and the scene
  /// is nowhere near.
  std::optional<Witness> witness = std::nullopt;

  bool operator==(const CollisionInterval&) const = default;
};

}  // namespace camway::collision
