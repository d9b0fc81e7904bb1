// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "daemon/geometry/triangle_tree.h"

namespace camway::geometry {

/// Number of times that a closed, consistently oriented surface goes round `point`: 0 outside, 1
/// inside if seen counter-clockwise from outside, 2 where two such insides overlap. Counts,
/// exactly, how often a ray from the point leaves the surface less how often it enters it
/// (`ray_hit`). Returns nothing if the ray finds the point on a triangle. `tree` is that of
/// `triangles`.
std::optional<int> winding_number(const Vec3& point, std::span<const Triangle> triangles,
                                  const TriangleTree& tree);

}  // namespace camway::geometry
