// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/geometry/types.h"

namespace camway::collision {

/// Shows where the body collides: the deepest contact at about the middle of a collision interval.
/// No part of any proof.
struct Witness {
  double time_s = 0.0;
  /// Triangle of the scene, or number of a side of the bounds (`Obstacles::is_side`).
  std::uint32_t triangle = 0;
  std::uint32_t feature = 0;  ///< feature of the body, see `motion::Body::feature_name`
  /// Estimate of the least distance by which the body would have to move at `time_s` to keep the
  /// required clearance from the triangle, or to be inside the side of the bounds. [Units: metres]
  double depth_m = 0.0;
  geometry::Vec3 point_W = geometry::Vec3::Zero();  ///< point of the triangle nearest to the body

  bool operator==(const Witness&) const = default;
};

/// A maximal closed time range in which the body collides with the scene, is nearer than the
/// required clearance, or is not wholly within the bounds. `t_begin_s == t_end_s` for a touch at
/// one instant.
struct CollisionInterval {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  /// Nothing if no witness was searched, or if all stretches of the interval are undecided and have
  /// no obstacle near.
  std::optional<Witness> witness = std::nullopt;

  bool operator==(const CollisionInterval&) const = default;
};

}  // namespace camway::collision
