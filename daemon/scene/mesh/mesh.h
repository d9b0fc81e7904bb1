// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "daemon/geometry/types.h"

namespace camway::scene {

/// A named range of triangles of a mesh.
struct MeshObject {
  std::string name;
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
};

/// Triangles, in the frame of the world unless a name says otherwise (`mesh_O`). Every index is
/// valid and every coordinate finite. [Units: metres]
struct Mesh {
  std::vector<geometry::Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<MeshObject>
      objects;  ///< in order of their triangles; together they cover all triangles

  [[nodiscard]] geometry::Triangle triangle(std::size_t index) const {
    const std::array<std::uint32_t, 3>& t = triangles[index];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
  [[nodiscard]] geometry::Box bounds() const;
  /// Returns the memory of vertices and triangles. [Units: bytes]
  [[nodiscard]] std::uint64_t memory_bytes() const;
};

/// One of the meshes of an object. All revisions that have it share it. The parts of an object are
/// ordered by their keys, which are unique.
struct MeshPart {
  static MeshPart of(std::uint64_t key, Mesh mesh);

  std::uint64_t key = 0;
  std::shared_ptr<const Mesh> mesh;  ///< never null
  geometry::Box bounds;              ///< bounds of the mesh
};

/// Returns one mesh of all parts, in their order, with one unnamed object. Does not merge vertices.
Mesh joined(std::span<const MeshPart> parts);

}  // namespace camway::scene
