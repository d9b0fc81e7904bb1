// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "daemon/base/result.h"
#include "daemon/scene/mesh/mesh.h"

/// Triangle meshes of shapes, each about its own origin. Curved surfaces are approximated from
/// outside: the mesh encloses the shape and is nowhere farther from it than the chord error. An
/// error names the invalid number and says why.
namespace camway::scene {

/// Limit of the lengths of a shape and of the magnitude of coordinates of points.
inline constexpr double kLargestShapeM = 1e9;
/// Limit of triangles; shapes that need more are refused.
inline constexpr std::size_t kMaxShapeTriangles = 2'000'000;

/// The exact box of this size: 12 triangles. [Limit: 0 < size_m <= kLargestShapeM on each axis]
base::Result<Mesh> box_mesh(const geometry::Vec3& size_m);

/// The part of the radius that a chord error has where none is asked for.
inline constexpr double kUsualChordShare = 0.01;

/// A polyhedron around a ball: an icosahedron whose faces are divided until the chord error is
/// kept. [Limit: 0 < radius_m <= kLargestShapeM; 1e-6·radius_m <= chord_error_m]
base::Result<Mesh> sphere_mesh(double radius_m, double chord_error_m);

/// A prism around a cylinder with axis z, whose flat ends it shares.
/// [Limit: as for the sphere; 0 < height_m <= kLargestShapeM]
base::Result<Mesh> cylinder_mesh(double radius_m, double height_m, double chord_error_m);

/// The faces between cubes of a grid that contain a point and cubes that contain none. A point on a
/// face may count for either side. The cubes have the edge `cell_m`, and one has its lowest corner
/// at the origin. Exact up to rounding, 2^-52 of a coordinate. [Limit: 0 < cell_m <=
/// kLargestShapeM; points within kMaxCloudCells of the origin on each axis]
base::Result<Mesh> cloud_mesh(std::span<const geometry::Vec3> points, double cell_m);

inline constexpr std::int32_t kMaxCloudCells = (std::int32_t{1} << 20) - 2;

}  // namespace camway::scene
