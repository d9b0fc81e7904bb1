// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Distance between two closed triangles, 0 exactly if `triangles_touch`. Degenerate triangles are
/// the segments or points that they are.
///
/// The error is at most `triangle_distance_error_m(a, b)`, to either side. Symmetric in its
/// arguments and independent of the order of vertices up to that error, not bit for bit. [Limit:
/// coordinates finite and below kLargestCoordinate_m] [Units: metres]
///
/// The least of the 9 edge-edge and 6 vertex-face distances, in the order of Larsen, Gottschalk,
/// Lin & Manocha 2000 ("Fast distance queries with rectangular swept sphere volumes", section 4): a
/// pair of points is final once the slab between them separates the triangles. Deviation:
/// parameters come from cross products instead of the determinant `ac - b²`, which loses half of
/// the digits for nearly parallel edges, and every comparison has a derived margin.
double triangle_distance(const Triangle& a, const Triangle& b);

/// `triangle_distance` if that is `beyond_m` or less; otherwise possibly infinity, which is faster.
double triangle_distance(const Triangle& a, const Triangle& b, double beyond_m);

/// A distance, and a vector of any length along the shortest line from `a` to `b`. The vector is
/// arbitrary where they touch and where the distance is infinite.
struct TriangleGap {
  double distance_m;
  Vec3 direction;
};

/// `triangle_distance` with the direction.
TriangleGap triangle_gap(const Triangle& a, const Triangle& b, double beyond_m);

/// Width of the slab between `a` and `b` along `direction`; negative if their projections overlap.
/// At most their distance plus `triangle_distance_error_m`; minus infinity for a direction that is
/// too short. Unlike a distance it carries over to hulls: the smaller width of two triangles `a`
/// holds for everything between them. [Units: metres]
double slab_width_m(const Triangle& a, const Triangle& b, const Vec3& direction);

/// Bound of the error of `triangle_distance`. [Units: metres]
double triangle_distance_error_m(const Triangle& a, const Triangle& b);

/// Bound of the error for every pair whose coordinates differ by at most `scale_m` in any axis.
/// [Units: metres]
inline double triangle_distance_error_m(double scale_m) {
  return 192.0 * kUnitRoundoff * scale_m + kSmallestNormal;  // derived beside `triangle_gap`
}

}  // namespace camway::geometry
