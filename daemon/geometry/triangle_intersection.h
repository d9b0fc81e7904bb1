// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Whether the closed triangles have a point in common. Touching counts, and the answer is exact:
/// there is no tolerance. Degenerate triangles are the segments or points that they are.
///
/// The result is symmetric (`triangles_touch(a, b) == triangles_touch(b, a)`), and independent of
/// the order of vertices and of the distance from the origin. Requires finite coordinates.
/// Thread-safe, like every kernel here.
///
/// Staged (after Shewchuk 1997): doubles with a derived bound prove most pairs apart by a
/// separating axis, or together by the signs of volumes; undecided pairs go to integer arithmetic
/// (`exact_triangles.h`). The first two stages take 20 to 300 ns.
bool triangles_touch(const Triangle& a, const Triangle& b);

}  // namespace camway::geometry
