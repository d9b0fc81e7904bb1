// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::correction {

/// A box with closed faces, except for holes that are too narrow for a flat body.
struct CageBox {
  geometry::Box box;  ///< box in a frame of its own
  /// Rotation from that frame to the world, of unit length; both have the same origin.
  geometry::Quat orientation = geometry::Quat::Identity();
  /// Bound of the distance of two points in one hole. [Units: metres]
  double widest_hole_m = 0.0;
  /// Shortest chord through the centre of the body: the smaller side of the smallest near
  /// quadrilateral that the request allows. More than `widest_hole_m`. [Units: metres]
  double shortest_chord_m = 0.0;
};

}  // namespace camway::correction
