// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "daemon/scene/mesh/mesh.h"
#include "tests/support/scenes.h"

/// Closed surfaces, and surfaces that are not closed.
namespace camway::testing {

/// Adds a surface over a parameter grid that is closed in both directions: `point(i, j)` for
/// 0 <= i < rows and 0 <= j < columns. Row `rows` is row 0, in reverse order if `mirrored`.
inline void add_closed_grid(scene::Mesh& mesh, std::uint32_t rows, std::uint32_t columns,
                            bool mirrored,
                            const std::function<Vec3(std::uint32_t, std::uint32_t)>& point) {
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) mesh.vertices.push_back(point(i, j));
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    j %= columns;
    if (i == rows && mirrored) j = (columns - j) % columns;
    return first + (i % rows) * columns + j;
  };
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
}

/// Adds a torus about the y axis.
inline void add_torus(scene::Mesh& mesh, const Vec3& center, double radius_m, double tube_m) {
  constexpr std::uint32_t kRows = 24;
  constexpr std::uint32_t kColumns = 12;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  add_closed_grid(mesh, kRows, kColumns, false, [&](std::uint32_t i, std::uint32_t j) {
    const double around = kTurn * i / kRows;
    const double across = kTurn * j / kColumns;
    const double r = radius_m + tube_m * std::cos(across);
    return Vec3(center +
                Vec3(r * std::cos(around), tube_m * std::sin(across), r * std::sin(around)));
  });
}

/// Adds a Klein bottle: a figure eight that rotates by half a turn along a circle of `radius_m`
/// about the y axis. It is not orientable and intersects itself along that circle. Each half of the
/// eight is `tube_m` wide.
inline void add_klein_bottle(scene::Mesh& mesh, double radius_m, double tube_m) {
  constexpr std::uint32_t kRows = 40;
  constexpr std::uint32_t kColumns = 24;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  add_closed_grid(mesh, kRows, kColumns, true, [&](std::uint32_t i, std::uint32_t j) {
    const double u = kTurn * i / kRows;
    const double v = kTurn * j / kColumns;
    const double a = tube_m * std::sin(v);
    const double b = tube_m * std::sin(2.0 * v) / 2.0;
    const double r = radius_m + std::cos(u / 2.0) * a - std::sin(u / 2.0) * b;
    const double height = std::sin(u / 2.0) * a + std::cos(u / 2.0) * b;
    return Vec3(r * std::cos(u), height, r * std::sin(u));
  });
}

/// Adds an octahedron whose vertices lie on the axes through `center`.
inline void add_octahedron(scene::Mesh& mesh, const Vec3& center, double radius_m) {
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int k = 0; k < 3; ++k) {
    mesh.vertices.push_back(center + radius_m * Vec3::Unit(k));
    mesh.vertices.push_back(center - radius_m * Vec3::Unit(k));
  }
  for (std::uint32_t x = 0; x < 2; ++x) {
    for (std::uint32_t y = 2; y < 4; ++y) {
      for (std::uint32_t z = 4; z < 6; ++z) {
        mesh.triangles.push_back({first + x, first + y, first + z});
      }
    }
  }
}

/// Adds a sphere: an octahedron whose triangles are cut into four, `times` times. Vertices are
/// repeated, as in an STL file.
inline void add_sphere(scene::Mesh& mesh, const Vec3& center, double radius_m, int times) {
  scene::Mesh octahedron;
  add_octahedron(octahedron, Vec3::Zero(), 1.0);
  const std::function<void(const geometry::Triangle&, int)> add = [&](const geometry::Triangle& t,
                                                                      int left) {
    if (left == 0) {
      const auto placed = [&](const Vec3& v) { return Vec3(center + radius_m * v); };
      add_triangle(mesh, placed(t[0]), placed(t[1]), placed(t[2]));
      return;
    }
    // Addition is commutative in floating point, so adjacent triangles have the same vertices.
    const Vec3 ab = Vec3(t[0] + t[1]).normalized();
    const Vec3 bc = Vec3(t[1] + t[2]).normalized();
    const Vec3 ca = Vec3(t[2] + t[0]).normalized();
    add({t[0], ab, ca}, left - 1);
    add({ab, t[1], bc}, left - 1);
    add({ca, bc, t[2]}, left - 1);
    add({ab, bc, ca}, left - 1);
  };
  for (std::size_t t = 0; t < octahedron.triangles.size(); ++t) add(octahedron.triangle(t), times);
}

/// Adds the four faces of a tetrahedron.
inline void add_tetrahedron(scene::Mesh& mesh, const std::array<Vec3, 4>& v) {
  add_triangle(mesh, v[0], v[1], v[2]);
  add_triangle(mesh, v[0], v[1], v[3]);
  add_triangle(mesh, v[0], v[2], v[3]);
  add_triangle(mesh, v[1], v[2], v[3]);
}

/// Returns two rooms of side 1 m that share the wall x = 0, whose edges have three triangles.
inline scene::Mesh two_rooms() {
  scene::Mesh mesh;
  add_cuboid(mesh, Vec3(-1, 0, 0), Vec3(0, 1, 1));
  add_cuboid(mesh, Vec3(0, 0, 0), Vec3(1, 1, 1));
  // Remove the second copy of the wall: the triangles of the second room with x = 0 everywhere.
  std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& t) {
    return t[0] >= 8 && mesh.vertices[t[0]].x() == 0.0 && mesh.vertices[t[1]].x() == 0.0 &&
           mesh.vertices[t[2]].x() == 0.0;
  });
  return mesh;
}

}  // namespace camway::testing
