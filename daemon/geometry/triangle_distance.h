// SPDX-License-Identifier: MIT
#pragma once

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
/// the digits for edges nearly parallel, and every comparison has a derived margin.
double triangle_distance(const Triangle& a, const Triangle& b);

/// The same where it is `beyond_m` or less; else it may be infinity instead, which is found out
/// sooner.
double triangle_distance(const Triangle& a, const Triangle& b, double beyond_m);

/// A distance, and a vector along the shortest way from `a` to `b`, in no particular unit. Where
/// they touch, and where the distance is infinity, any vector.
struct TriangleGap {
  double distance_m;
  Vec3 direction;
};

/// `triangle_distance` with the direction.
TriangleGap triangle_gap(const Triangle& a, const Triangle& b, double beyond_m);

/// How far `b` lies beyond `a` along `direction`: the width of the slab between them, below 0 if
/// they overlap. Never above their distance by more than `triangle_distance_error_m`; minus
/// infinity for a direction too short to have one. Other than a distance it tells something of
/// everything between two triangles `a`. [Units: metres]
double slab_width_m(const Triangle& a, const Triangle& b, const Vec3& direction);

/// Bound of the error of `triangle_distance`, metres.
double triangle_distance_error_m(const Triangle& a, const Triangle& b);

/// The same for every pair whose coordinates differ by no more than `scale_m` in any axis.
double triangle_distance_error_m(double scale_m);

}  // namespace camway::geometry
