// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "daemon/motion/body/body.h"

/// Meshes of many triangles, as bodies.
namespace camway::testing {

/// Returns the filled near quadrilateral of a camera, divided in `columns` × `rows` cells of two
/// triangles.
inline motion::MeshShape divided_quad(const motion::Camera& camera, std::uint32_t columns,
                                      std::uint32_t rows) {
  const motion::Corners corners = motion::near_corners_C(camera);
  motion::MeshShape mesh;
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double x = static_cast<double>(i) / columns;
      const double y = static_cast<double>(j) / rows;
      mesh.vertices_C.emplace_back(corners[2] + x * (corners[3] - corners[2]) +
                                   y * (corners[1] - corners[2]));
    }
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t at = j * (columns + 1) + i;
      mesh.triangles.push_back({at, at + 1, at + columns + 2});
      mesh.triangles.push_back({at, at + columns + 2, at + columns + 1});
    }
  }
  return mesh;
}

/// Returns a torus about the z axis of `around` × `across` × 2 triangles, seen counter-clockwise
/// from outside. Its inside is what is nearer than `thin_m` to a circle of radius `wide_m`.
inline motion::MeshShape torus(double wide_m, double thin_m, std::uint32_t around,
                               std::uint32_t across,
                               const geometry::Vec3& center_C = geometry::Vec3::Zero()) {
  motion::MeshShape mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    const double a = 2.0 * std::numbers::pi * i / around;
    for (std::uint32_t j = 0; j < across; ++j) {
      const double b = 2.0 * std::numbers::pi * j / across;
      const double radius_m = wide_m + thin_m * std::cos(b);
      mesh.vertices_C.emplace_back(center_C + geometry::Vec3(radius_m * std::cos(a),
                                                             radius_m * std::sin(a),
                                                             thin_m * std::sin(b)));
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return i % around * across + j % across;
  };
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

}  // namespace camway::testing
