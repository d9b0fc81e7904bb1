// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::correction {

/// A box whose faces are closed but for holes too narrow for a flat body.
struct CageBox {
  geometry::Box box;  ///< in a frame of its own
  /// Turns vectors of that frame into the world; both have the same origin. [unit length]
  geometry::Quat orientation = geometry::Quat::Identity();
  /// No two points of one hole are further apart. [Units: metres]
  double widest_hole_m = 0.0;
  /// Of those through the centre of the body: the smaller side of a near quadrilateral, the
  /// smallest that the request allows. More than `widest_hole_m`. [Units: metres]
  double shortest_chord_m = 0.0;
};

}  // namespace camway::correction
