// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

/// Returns whether the ray from `origin` (`geometry::ray_hit`) meets an odd number of the
/// triangles; nothing if it finds `origin` on one.
std::optional<bool> is_odd(const geometry::Vec3& origin, const scene::Mesh& mesh,
                           std::span<const std::uint32_t> triangles);

/// Whether each edge, by the exact coordinates of its ends, belongs to an even number of the
/// triangles. A triangle that is listed twice counts twice.
bool is_closed(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles);

}  // namespace camway::correction
