// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "daemon/scene/mesh/mesh.h"

/// Scenes for tests of drawings; y points up.
namespace camway::draw {

/// Seed of the random cases of these tests.
inline constexpr std::uint64_t kDrawSeed = 20060;

/// Adds a closed box as one object.
inline void add_box(scene::Mesh& mesh, const geometry::Vec3& low, const geometry::Vec3& high) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1U) != 0 ? high.x() : low.x(),
                               (i & 2U) != 0 ? high.y() : low.y(),
                               (i & 4U) != 0 ? high.z() : low.z());
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  const auto first_triangle = static_cast<std::uint32_t>(mesh.triangles.size());
  for (const auto& f : kFaces) {
    mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
    mesh.triangles.push_back({first + f[0], first + f[2], first + f[3]});
  }
  mesh.objects.push_back({"box", first_triangle, 12});
}

/// Returns two storeys of 6 x 4 m: floors at 0 and 3 m, a wall, a table.
inline scene::Mesh small_house() {
  scene::Mesh mesh;
  add_box(mesh, {0, -0.2, 0}, {6, 0, 4});
  add_box(mesh, {0, 2.8, 0}, {6, 3, 4});
  add_box(mesh, {3, 0, 0}, {3.2, 2.8, 2.5});
  add_box(mesh, {4, 0, 1}, {5, 0.7, 2});
  return mesh;
}

/// Returns a point, turned so that z points up.
inline geometry::Vec3 turned_to_z_up(const geometry::Vec3& p) { return {p.x(), -p.z(), p.y()}; }

inline scene::Mesh turned_to_z_up(scene::Mesh mesh) {
  for (geometry::Vec3& v : mesh.vertices) v = turned_to_z_up(v);
  return mesh;
}

}  // namespace camway::draw
