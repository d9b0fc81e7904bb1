// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/motion/body/body.h"

namespace camway::motion {

/// For each vertex of `mesh` the lowest number of a vertex at the same place.
std::vector<std::uint32_t> welded_vertices(const MeshShape& mesh);

/// Returns why the mesh is no closed surface with an inside, and names the edge; nothing if each
/// edge has exactly two triangles, which run through it in opposite directions. Vertices at the
/// same place are one vertex, and triangles with two equal vertices do not count. Requires that
/// all vertices of triangles exist.
std::optional<std::string> fault_of_surface(const MeshShape& mesh);

/// The number of one triangle of each connected part of the mesh, in increasing order. Triangles
/// are connected by a vertex.
std::vector<std::uint32_t> connected_parts(const MeshShape& mesh);

}  // namespace camway::motion
