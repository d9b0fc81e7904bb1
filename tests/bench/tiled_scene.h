// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "daemon/scene/mesh/mesh.h"

/// Scenes of any size, made from another scene.
namespace camway::bench {

/// Returns copies of the mesh side by side along its two longer axes, in a square around the
/// original, with at least `least` triangles: more space with the same density. The original keeps
/// its place.
std::shared_ptr<const scene::Mesh> tiled(const scene::Mesh& mesh, std::size_t least);

/// Returns the mesh with every triangle cut into four repeatedly, until there are at least `least`:
/// the same space with finer triangles.
std::shared_ptr<const scene::Mesh> refined(const scene::Mesh& mesh, std::size_t least);

/// Returns the `most` triangles whose centres are nearest to `center`.
std::shared_ptr<const scene::Mesh> cropped(const scene::Mesh& mesh, const geometry::Vec3& center,
                                           std::size_t most);

/// Returns small triangles scattered over a cube, without surfaces and without empty rooms.
std::shared_ptr<const scene::Mesh> dust(std::size_t count, std::uint64_t seed);

/// Returns a hilly ground of 100 m × 100 m on a regular grid: one surface of similar triangles.
std::shared_ptr<const scene::Mesh> terrain(std::size_t least);

}  // namespace camway::bench
