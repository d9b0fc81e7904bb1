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

/// Whether the ray from `origin` along +x goes through `triangle`, exactly. The ray is moved by ε
/// along y and by ε² along z, for an ε smaller than anything else ("simulation of simplicity";
/// Edelsbrunner & Mücke 1990), so it passes no vertex and no edge and lies in no plane: what seems
/// to meet one of two triangles over their common edge meets exactly one of them, or both, or none,
/// as the moved ray does. A closed surface that `origin` is not on separates it from none of the
/// points it is moved to.
/// kOnTriangle: `origin` is on the triangle, which is told only where the moved ray would start on
/// its plane inside it.
RayHit ray_hit(const geometry::Vec3& origin, const geometry::Triangle& triangle);

/// Whether an odd number of these triangles meets the ray; nothing if `origin` is seen to be on
/// one.
std::optional<bool> is_odd(const geometry::Vec3& origin, const scene::Mesh& mesh,
                           std::span<const std::uint32_t> triangles);

/// Whether each edge, by the exact coordinates of its ends, belongs to an even number of the
/// triangles. An index that is given twice counts twice.
bool is_closed(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles);

}  // namespace camway::correction
