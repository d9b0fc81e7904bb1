// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

/// Returns a mesh of these triangles, in this order, each with vertices of its own.
inline Mesh mesh_of_triangles(const std::vector<geometry::Triangle>& triangles) {
  Mesh mesh;
  for (const geometry::Triangle& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), triangle.begin(), triangle.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.objects.push_back({"test", 0, static_cast<std::uint32_t>(triangles.size())});
  return mesh;
}

}  // namespace camway::scene
