// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// Where along `segment` its first common point with the closed triangle lies: a fraction in [0, 1]
/// from `from` to `to`, or nothing.
///
/// *Whether* they meet is exact, so a segment through an edge that two triangles share hits both,
/// and nothing slips between them; a segment of length zero is a point, degenerate triangles are
/// the segments or points that they are.
///
/// *Where* is rounded: the point named lies within `triangle_distance_error_m` of the triangle,
/// times the ratio of its longest edge to its height. Where segment and plane are nearly parallel
/// that can be far along the segment. A segment in the plane of the triangle is hit where it enters
/// it.
std::optional<double> hit_fraction(const LineSegment& segment, const Triangle& triangle);

}  // namespace camway::geometry
