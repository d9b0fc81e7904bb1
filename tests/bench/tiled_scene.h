// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "daemon/scene/mesh/mesh.h"

/// Scenes of any size, made from one that is at hand.
namespace camway::bench {

/// Copies side by side along the two longer axes, in a square about the original, until there are
/// `least` triangles: more space, the same density everywhere. The original stays where it is.
std::shared_ptr<const scene::Mesh> tiled(const scene::Mesh& mesh, std::size_t least);

/// Every triangle cut into four, as often as it takes: the same space, finer triangles.
std::shared_ptr<const scene::Mesh> refined(const scene::Mesh& mesh, std::size_t least);

/// The `most` triangles whose middles are nearest to `center`: a smaller scene.
std::shared_ptr<const scene::Mesh> cropped(const scene::Mesh& mesh, const geometry::Vec3& center,
                                           std::size_t most);

/// Small triangles strewn over a cube: no surfaces, no empty rooms.
std::shared_ptr<const scene::Mesh> dust(std::size_t count, std::uint64_t seed);

/// A hilly ground of 100 m × 100 m on a regular grid: one surface, all triangles alike.
std::shared_ptr<const scene::Mesh> terrain(std::size_t least);

}  // namespace camway::bench
