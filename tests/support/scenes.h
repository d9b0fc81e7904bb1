// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/scene/index/scene_index.h"
#include "tests/support/random.h"

/// Small scenes and cameras that tests build in memory.
namespace camway::testing {

using geometry::Quat;
using geometry::Vec3;

/// Adds an axis-parallel cuboid of 12 triangles.
inline void add_cuboid(scene::Mesh& mesh, const Vec3& min, const Vec3& max) {
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) != 0 ? max.x() : min.x(), (i & 2) != 0 ? max.y() : min.y(),
                               (i & 4) != 0 ? max.z() : min.z());
  }
  constexpr std::array<std::array<std::uint32_t, 3>, 12> kFaces{{{0, 2, 1},
                                                                 {1, 2, 3},
                                                                 {4, 5, 6},
                                                                 {5, 7, 6},
                                                                 {0, 1, 4},
                                                                 {1, 5, 4},
                                                                 {2, 6, 3},
                                                                 {3, 6, 7},
                                                                 {0, 4, 2},
                                                                 {2, 4, 6},
                                                                 {1, 3, 5},
                                                                 {3, 7, 5}}};
  for (const std::array<std::uint32_t, 3>& face : kFaces) {
    mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
  }
}

/// Adds one triangle.
inline void add_triangle(scene::Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// Adds the parallelogram with the sides `u` and `v` at `corner`.
inline void add_parallelogram(scene::Mesh& mesh, const Vec3& corner, const Vec3& u, const Vec3& v) {
  add_triangle(mesh, corner, corner + u, corner + u + v);
  add_triangle(mesh, corner, corner + u + v, corner + v);
}

/// Returns triangles of about `size_m` scattered over a cube of side 2 m about the origin.
inline scene::Mesh scattered_triangles(Random& random, int count, double size_m) {
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  scene::Mesh mesh;
  const auto anywhere = [&] { return Vec3(place(random), place(random), place(random)); };
  for (int i = 0; i < count; ++i) {
    const Vec3 center = anywhere();
    add_triangle(mesh, center + size_m * anywhere(), center + size_m * anywhere(),
                 center + size_m * anywhere());
  }
  return mesh;
}

/// Returns a camera of 90° × 60° with a near distance of 10 cm; its quadrilateral has 0.2 m × 0.115
/// m.
inline motion::Camera small_camera() {
  return {.fov_x_rad = std::numbers::pi / 2, .fov_y_rad = std::numbers::pi / 3, .near_m = 0.1};
}

/// Returns the orientation that looks along `forward`, with +Y up as far as possible.
inline Quat looking_along(const Vec3& forward) {
  const Vec3 back = -forward.normalized();
  const Vec3 right = Vec3::UnitY().cross(back).normalized();
  Eigen::Matrix3d axes;
  axes << right, back.cross(right), back;
  return Quat(axes);
}

}  // namespace camway::testing
