// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::collision {

/// Returns a distance such that the two triangles still touch after each point of one of them has
/// moved by less than it, each in its own way. This is proved, rounding included. Returns 0 if the
/// triangles do not touch or if nothing can be proved. May also return 0 in place of a distance up
/// to `enough_m`, which saves time. [Units: metres]
///
/// The proof: let an edge of one triangle pass through the inside of the other. If every point
/// moves by less than the distances between the edge's ends and the pierced triangle, and between
/// the edge and the border of the pierced triangle, then on the way from the old place to the new
/// one (all points along straight lines at once) the ends never meet the triangle and the edge
/// never meets the border. The parity of the number of crossings of a curve through a disc cannot
/// change otherwise (Guillemin & Pollack 1974, "Differential topology", section 2.4), so it stays
/// odd. It does not matter which of the two moves, nor whether it moves rigidly.
double crossing_margin_m(const geometry::Triangle& a, const geometry::Triangle& b, double enough_m);

}  // namespace camway::collision
