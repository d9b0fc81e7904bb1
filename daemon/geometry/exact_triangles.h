// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Whether the closed triangles have a point in common, in integer arithmetic without any rounding.
/// Handles triangles that are segments or points. Takes tens of microseconds, so `triangles_touch`
/// calls it only where doubles cannot decide. Requires every coordinate to be finite.
///
/// Two convex sets are disjoint exactly if a plane separates them, and for two triangles the normal
/// of that plane can be found among finitely many (separating axis theorem; Gottschalk, Lin &
/// Manocha 1996). Deviation: the list is extended by the cases in which the Minkowski difference of
/// the two is flat, a segment or a point, so that it is complete for degenerate input too.
bool triangles_touch_exactly(const Triangle& a, const Triangle& b);

/// Whether the vertices lie on one line, exactly. Decided in doubles where possible, so it is cheap
/// for all but the thinnest triangles. Requires every coordinate to be finite.
bool has_no_area_exactly(const Triangle& triangle);

}  // namespace camway::geometry
