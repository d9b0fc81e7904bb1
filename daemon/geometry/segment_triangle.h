// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Returns where along `segment` its first common point with the closed triangle lies, as a
/// fraction in [0, 1] from `from` to `to`; nothing if they do not meet.
///
/// *Whether* they meet is exact, so a segment through an edge that two triangles share hits both,
/// and none slips between them. A segment of length zero is a point; degenerate triangles are the
/// segments or points that they are.
///
/// *Where* they meet is rounded: the point is within `triangle_distance_error_m` of the triangle,
/// times the ratio of the triangle's longest edge to its height. If segment and plane are nearly
/// parallel, it may be far off along the segment. A segment in the plane of the triangle is hit
/// where it enters the triangle.
std::optional<double> hit_fraction(const LineSegment& segment, const Triangle& triangle);

}  // namespace camway::geometry
