// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "daemon/geometry/half_space.h"

namespace camway::geometry {

/// The convex hull of a set of points.
struct ConvexHull {
  /// The surface, as indices of points, counter-clockwise seen from outside. A flat set has the
  /// triangles of its polygon, once; a set on a line has the triangle `(a, b, b)`, a point
  /// `(a, a, a)`.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// The faces, with coplanar triangles counted once; none for a set without volume. All points
  /// satisfy each half-space exactly, by its numbers as stored.
  std::vector<HalfSpace> faces;
};

/// Computes the hull exactly: no point is outside of it by any amount, so every object that touches
/// the hull of the points touches these triangles or lies inside. Handles coplanar, collinear and
/// equal points.
///
/// Quickhull (Barber, Dobkin & Huhdanpaa 1996, section 2). Deviation: positions are decided without
/// rounding (`ExactPoints`), instead of merging facets that rounding makes concave. A point that is
/// slightly off all faces may be far from the hull where the hull is sharp, and then no tolerance
/// of the faces bounds the error. Expected O(n log n). Deterministic.
///
/// Requires at least one point; all must be finite and at most `kLargestHullCoordinate_m`.
ConvexHull convex_hull(std::span<const Vec3> points);

}  // namespace camway::geometry
