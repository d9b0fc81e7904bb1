// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "daemon/scene/mesh/mesh.h"

namespace camway::view {

/// The triangles of a scene that is shown, of all of its objects together.
inline constexpr std::int64_t kShownTriangles = 500'000;

/// Returns how many triangles an object of a scene may have when it is shown, so that all objects
/// keep `kShownTriangles` together. The share of a scene changes in steps, so that a small change
/// elsewhere in the scene leaves the picture of an object as it is. Both numbers are those of
/// triangles before simplification. [Limit: 0 <= object <= scene]
std::size_t triangles_to_show(std::int64_t object_triangles, std::int64_t scene_triangles);

/// Returns a mesh as `.glb` for a page: one node with its place and scale, one mesh of triangles
/// with positions alone, compressed (EXT_meshopt_compression, KHR_mesh_quantization). Without
/// triangles there is a node without a mesh. `asset.extras` has `triangles`, `shown`, `simplified`
/// and `error_m`, as `DisplayMesh` has them.
std::string mesh_glb(const scene::Mesh& mesh_O, std::size_t most_triangles);

}  // namespace camway::view
