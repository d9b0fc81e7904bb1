// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daemon/correction/path/free_space.h"
#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// A linearised distance constraint on a step from a pose: after the step, a vertex of the body is
/// `room_m + direction · step` beyond the plane that separates it from a triangle of the scene, or
/// inside a side of the bounds.
struct ContactRow {
  StackedPoint direction;
  double room_m = 0.0;
  /// Triangle of the scene or side of the bounds (`Obstacles::is_side`).
  std::uint32_t triangle = 0;
  std::size_t vertex = 0;  ///< vertex of the body: 3 × its triangle + its index in the triangle
};

/// A place of the body on a path, in stacked coordinates, and how it may move from there.
struct StackedPlace {
  StackedPoint point;
  geometry::Vec4 reference;  ///< the reference frame of images
  double lever_m = 0.0;      ///< the lever arm of `StackedPoint`
  bool may_turn = true;      ///< if false, the rows do not constrain the orientation
};

/// Adds the rows of `obstacles` for the body at `place`. For a triangle of the scene and each
/// triangle of the body the plane is perpendicular to the shortest line between the two; rows are
/// added for the vertices within `horizon_m` of it, the tightest ones where there are many.
/// Requires the body to be free of the obstacles at `place`.
void add_contact_rows(FreeSpace& space, const StackedPlace& place,
                      std::span<const std::uint32_t> obstacles, double horizon_m,
                      std::vector<ContactRow>& rows);

}  // namespace camway::correction
