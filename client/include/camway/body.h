// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace camway {

/// The shape that moves along a path and must not collide. Coordinates are metres in the camera
/// frame: the eye is the origin, the camera looks down -Z, +Y is up. Set only the members
/// that `shape` names.
///
///     request.body = camway::Body::box({0.4, 0.2, 0.4});   // a drone around its camera
struct Body {
  enum class Shape {
    kCamera,     ///< the near quadrilateral of the request's camera
    kBox,        ///< a solid box along the camera's axes: `center_m`, `size_m`
    kSphere,     ///< a solid ball: `center_m`, `radius_m`
    kConvex,     ///< a union of solid convex hulls: `pieces_m`
    kMesh,       ///< a surface without an inside: `vertices_m`, `triangles`
    kSolidMesh,  ///< a closed surface and its inside: `vertices_m`, `triangles`
  };
  using Point = std::array<double, 3>;

  Shape shape = Shape::kCamera;
  Point center_m{};
  Point size_m{};         ///< full edge lengths along x, y, z [Limit: 0 < value]
  double radius_m = 0.0;  ///< [Limit: 0 < value]
  /// Point sets; the body is the union of their convex hulls. [Limit: 512 points in all]
  std::vector<std::vector<Point>> pieces_m;
  std::vector<Point> vertices_m;  ///< [Limit: 100,000 vertices]
  /// Indices into `vertices_m`, counted from 0. [Limit: 100,000 triangles]
  std::vector<std::array<std::int32_t, 3>> triangles;

  static Body box(const Point& size_m, const Point& center_m = {}) {
    Body body;
    body.shape = Shape::kBox;
    body.size_m = size_m;
    body.center_m = center_m;
    return body;
  }
  static Body sphere(double radius_m, const Point& center_m = {}) {
    Body body;
    body.shape = Shape::kSphere;
    body.radius_m = radius_m;
    body.center_m = center_m;
    return body;
  }
  static Body convex(std::vector<std::vector<Point>> pieces_m) {
    Body body;
    body.shape = Shape::kConvex;
    body.pieces_m = std::move(pieces_m);
    return body;
  }
  static Body mesh(std::vector<Point> vertices_m,
                   std::vector<std::array<std::int32_t, 3>> triangles) {
    Body body;
    body.shape = Shape::kMesh;
    body.vertices_m = std::move(vertices_m);
    body.triangles = std::move(triangles);
    return body;
  }
  /// Each edge has two triangles, which run through it in opposite directions.
  static Body solid_mesh(std::vector<Point> vertices_m,
                         std::vector<std::array<std::int32_t, 3>> triangles) {
    Body body = mesh(std::move(vertices_m), std::move(triangles));
    body.shape = Shape::kSolidMesh;
    return body;
  }
};

}  // namespace camway
