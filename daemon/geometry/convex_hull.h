// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "daemon/geometry/half_space.h"

namespace camway::motion {

/// The convex hull of a set of points.
struct ConvexHull {
  /// Its surface, as indices of points. Counter-clockwise seen from outside. A flat set has the
  /// triangles of its polygon, once; a set on a line the one triangle `(a, b, b)`, a point
  /// `(a, a, a)`.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Its faces, coplanar triangles counted once; none for a set without volume. All points satisfy
  /// each of them, as numbers stand here and without rounding.
  std::vector<geometry::HalfSpace> faces;
};

/// The hull, exactly: no point is outside of it by any amount, so whatever touches the set's hull
/// touches these triangles or lies inside. Coplanar, collinear and equal points are no special
/// cases for the caller.
///
/// Quickhull (Barber, Dobkin & Huhdanpaa 1996, section 2). Deviation: positions are judged without
/// rounding (`ExactPoints`) instead of merging facets that rounding makes concave, because a point
/// that is off all faces by little may be far from the hull where it is sharp, and then no
/// tolerance of the faces bounds what was lost. Expected O(n log n). Deterministic.
///
/// Precondition: points are finite and at most kMaxBodyCoordinate_m, and there is one.
ConvexHull convex_hull(std::span<const geometry::Vec3> points);

}  // namespace camway::motion
