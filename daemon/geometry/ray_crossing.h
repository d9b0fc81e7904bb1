// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// How a ray meets a triangle. `kLeaves` and `kEnters`: it passes through, in the direction of the
/// side from which the triangle is seen counter-clockwise, or against it.
enum class RayHit : std::uint8_t { kMiss, kLeaves, kEnters, kOnTriangle };

/// Whether the ray from `origin` along +x meets `triangle`, exactly. The ray is shifted by ε along
/// y and by ε² along z, for an ε smaller than anything else ("simulation of simplicity";
/// Edelsbrunner & Mücke 1990), so it meets no vertex and no edge and lies in no plane. Where the
/// unshifted ray meets the common edge of two triangles, the shifted ray meets one of them, both or
/// none. If `origin` is not on a closed surface, the shifted origins are on the same side of that
/// surface as `origin`.
///
/// Returns kOnTriangle if `origin` lies in the plane of the triangle and the shifted ray starts
/// inside the triangle. For an origin on the border of the triangle, or on a triangle that is
/// parallel to the x axis, it may return kMiss.
RayHit ray_hit(const Vec3& origin, const Triangle& triangle);

/// Whether the ray passes through the triangle, in either direction.
constexpr bool passes_through(RayHit hit) {
  return hit == RayHit::kLeaves || hit == RayHit::kEnters;
}

}  // namespace camway::geometry
