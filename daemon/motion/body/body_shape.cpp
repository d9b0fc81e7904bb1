// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "daemon/motion/body/body.h"
#include "daemon/motion/body/closed_mesh.h"

namespace camway::motion {
namespace {

using geometry::Vec3;
using Fault = std::optional<ShapeFault>;

bool is_size(double value) { return value > 0.0 && value <= kMaxBodyCoordinate_m; }

Fault fault_in_size(std::string field, double value_m) {
  if (is_size(value_m)) return std::nullopt;
  return ShapeFault{std::move(field), fmt::format("is {} m; it must be above 0 and at most {:g} m",
                                                  value_m, kMaxBodyCoordinate_m)};
}

Fault fault_in_point(const std::string& field, const Vec3& point) {
  if (!point.allFinite()) return ShapeFault{field, "is not finite"};
  if (point.lpNorm<Eigen::Infinity>() <= kMaxBodyCoordinate_m) return std::nullopt;
  return ShapeFault{field, fmt::format("is more than {:g} m from the eye", kMaxBodyCoordinate_m)};
}

Fault fault_in_count(const std::string& field, std::size_t count, std::size_t most) {
  if (count == 0) return ShapeFault{field, "is empty"};
  if (count <= most) return std::nullopt;
  return ShapeFault{field, fmt::format("holds {}; at most {} are allowed", count, most)};
}

/// The fault of a body without extent.
Fault single_point(std::string field) {
  return ShapeFault{std::move(field),
                    "is a single point, or that point repeated; a body needs two different points"};
}

Fault fault_in_shape(const Camera& camera) {
  const auto is_angle = [](double angle) { return angle > 0.0 && angle < std::numbers::pi; };
  if (!is_angle(camera.fov_x_rad) || !is_angle(camera.fov_y_rad) || !is_size(camera.near_m) ||
      !(body_radius_m(near_corners_C(camera)) <= kMaxBodyCoordinate_m)) {
    return ShapeFault{"", "the camera has no near quadrilateral, or one larger than any scene"};
  }
  return std::nullopt;
}

Fault fault_in_shape(const BoxShape& box) {
  if (Fault fault = fault_in_point("center", box.center_C)) return fault;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (Fault fault = fault_in_size(fmt::format("size[{}]", k), box.size_m[k])) return fault;
  }
  return std::nullopt;
}

Fault fault_in_shape(const SphereShape& sphere) {
  if (Fault fault = fault_in_point("center", sphere.center_C)) return fault;
  return fault_in_size("radius_m", sphere.radius_m);
}

Fault fault_in_shape(const ConvexShape& convex) {
  if (convex.pieces_C.empty()) return ShapeFault{"pieces", "is empty"};
  std::size_t count = 0;
  for (std::size_t i = 0; i < convex.pieces_C.size(); ++i) {
    const std::string piece =
        convex.pieces_C.size() == 1 ? std::string("points") : fmt::format("pieces[{}]", i);
    const std::vector<Vec3>& points = convex.pieces_C[i];
    if (points.empty()) return ShapeFault{piece, "is empty"};
    count += points.size();
    if (count > kMaxBodyPoints) {
      return ShapeFault{
          piece, fmt::format("passes the {} points that a body may have in all", kMaxBodyPoints)};
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (Fault fault = fault_in_point(fmt::format("{}[{}]", piece, k), points[k])) return fault;
    }
  }
  const Vec3& first = convex.pieces_C.front().front();
  const auto is_first = [&](const std::vector<Vec3>& points) {
    return std::ranges::all_of(points, [&](const Vec3& point) { return point == first; });
  };
  if (std::ranges::all_of(convex.pieces_C, is_first)) {
    return single_point(convex.pieces_C.size() == 1 ? "points" : "pieces");
  }
  return std::nullopt;
}

bool is_single_point(const MeshShape& mesh) {
  const Vec3& first = mesh.vertices_C[mesh.triangles.front().front()];
  const auto is_first = [&](std::uint32_t vertex) { return mesh.vertices_C[vertex] == first; };
  return std::ranges::all_of(mesh.triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
    return std::ranges::all_of(triangle, is_first);
  });
}

Fault fault_in_shape(const MeshShape& mesh) {
  if (Fault fault = fault_in_count("vertices", mesh.vertices_C.size(), kMaxBodyVertices))
    return fault;
  if (Fault fault = fault_in_count("triangles", mesh.triangles.size(), kMaxBodyTriangles))
    return fault;
  for (std::size_t i = 0; i < mesh.vertices_C.size(); ++i) {
    if (Fault fault = fault_in_point(fmt::format("vertices[{}]", i), mesh.vertices_C[i]))
      return fault;
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[i][k];
      if (vertex < mesh.vertices_C.size()) continue;
      return ShapeFault{fmt::format("triangles[{}][{}]", i, k),
                        fmt::format("is {}, but there are {} vertices, counted from 0", vertex,
                                    mesh.vertices_C.size())};
    }
  }
  if (is_single_point(mesh)) return single_point("triangles");
  if (!mesh.solid) return std::nullopt;
  if (std::optional<std::string> fault = fault_of_surface(mesh))
    return ShapeFault{"triangles", "are no closed surface: " + *fault};
  return std::nullopt;
}

}  // namespace

std::optional<ShapeFault> fault_in(const BodyShape& shape) {
  return std::visit([](const auto& part) { return fault_in_shape(part); }, shape);
}

}  // namespace camway::motion
