// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "daemon/scene/mesh/mesh.h"

/// Shapes as triangles, each about its own origin. What is curved is approximated from outside: the
/// triangles enclose the shape, and no point of them is further from it than a chord error that the
/// caller states.
namespace camway::scene {

/// A mesh, or why there is none: what is wrong with a number, which the text names.
struct ShapeMesh {
  std::optional<Mesh> mesh;
  std::string error;
};

/// No length of a shape is longer, nor any coordinate of a point further from the origin.
inline constexpr double kLargestShapeM = 1e9;
/// A shape that would need more triangles is refused.
inline constexpr std::size_t kMaxShapeTriangles = 2'000'000;

/// The box of this size, exactly: 12 triangles. [Limit: 0 < size_m <= kLargestShapeM on each axis]
ShapeMesh box_mesh(const geometry::Vec3& size_m);

/// A polyhedron about a ball: an icosahedron whose faces are divided until it keeps the chord
/// error. [Limit: 0 < radius_m <= kLargestShapeM; 1e-6·radius_m <= chord_error_m]
ShapeMesh sphere_mesh(double radius_m, double chord_error_m);

/// A prism about a cylinder with the axis z. Its flat ends are those of the cylinder.
/// [Limit: as of the sphere; 0 < height_m <= kLargestShapeM]
ShapeMesh cylinder_mesh(double radius_m, double height_m, double chord_error_m);

/// The faces between the cubes of a grid that hold a point and those that do not; a point in a face
/// belongs to either side of it. The cubes have the edge `cell_m`, and one has its lowest corner at
/// the origin. Up to rounding, 2^-52 of a coordinate. [Limit: 0 < cell_m <= kLargestShapeM; points
/// within kMaxCloudCells of the origin on each axis]
ShapeMesh cloud_mesh(std::span<const geometry::Vec3> points, double cell_m);

inline constexpr std::int32_t kMaxCloudCells = (std::int32_t{1} << 20) - 2;

}  // namespace camway::scene
