// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

enum class RayHit { kMiss, kHit, kOnTriangle };

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
RayHit ray_hit(const geometry::Vec3& origin, const geometry::Triangle& triangle);

/// Returns whether the ray meets an odd number of the triangles; nothing if `ray_hit` finds
/// `origin` on one.
std::optional<bool> is_odd(const geometry::Vec3& origin, const scene::Mesh& mesh,
                           std::span<const std::uint32_t> triangles);

/// Whether each edge, by the exact coordinates of its ends, belongs to an even number of the
/// triangles. A triangle that is listed twice counts twice.
bool is_closed(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles);

}  // namespace camway::correction
