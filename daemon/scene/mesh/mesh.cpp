// SPDX-License-Identifier: MIT
#include "daemon/scene/mesh/mesh.h"

#include <utility>

namespace camway::scene {

geometry::Box Mesh::bounds() const {
  geometry::Box box;
  for (const std::array<std::uint32_t, 3>& t : triangles) {
    for (const std::uint32_t v : t) box.extend(vertices[v]);
  }
  return box;
}

std::uint64_t Mesh::memory_bytes() const {
  return vertices.capacity() * sizeof(vertices[0]) + triangles.capacity() * sizeof(triangles[0]);
}

MeshPart MeshPart::of(std::uint64_t key, Mesh mesh) {
  const geometry::Box bounds = mesh.bounds();
  return {key, std::make_shared<const Mesh>(std::move(mesh)), bounds};
}

Mesh joined(std::span<const MeshPart> parts) {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  for (const MeshPart& part : parts) {
    vertices += part.mesh->vertices.size();
    triangles += part.mesh->triangles.size();
  }
  Mesh whole;
  whole.vertices.reserve(vertices);
  whole.triangles.reserve(triangles);
  for (const MeshPart& part : parts) {
    const auto first = static_cast<std::uint32_t>(whole.vertices.size());
    const Mesh& mesh = *part.mesh;
    whole.vertices.insert(whole.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
      whole.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  whole.objects.push_back({"", 0, static_cast<std::uint32_t>(triangles)});
  return whole;
}

}  // namespace camway::scene
