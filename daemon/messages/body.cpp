// SPDX-License-Identifier: MIT
#include "daemon/messages/body.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lcmtypes/wire/layout.h"

namespace camway::messages {
namespace {

using geometry::Vec3;
using motion::BodyShape;

static_assert(wire::kMaxBodyPoints == motion::kMaxBodyPoints);
static_assert(wire::kMaxBodyTriangles == motion::kMaxBodyTriangles);

Vec3 vec3(const double (&from)[3]) { return {from[0], from[1], from[2]}; }
Vec3 vec3(const std::vector<double>& from) { return {from[0], from[1], from[2]}; }

void add_points(const std::vector<Vec3>& points, body_t& wire) {
  for (const Vec3& point : points) wire.points_m.push_back({point.x(), point.y(), point.z()});
  wire.num_points = static_cast<std::int32_t>(wire.points_m.size());
}

void fill(const motion::Camera&, body_t& wire) { wire.type = body_t::CAMERA; }

void fill(const motion::BoxShape& box, body_t& wire) {
  wire.type = body_t::BOX;
  std::copy_n(box.center_C.data(), 3, wire.center_m);
  std::copy_n(box.size_m.data(), 3, wire.size_m);
}

void fill(const motion::SphereShape& sphere, body_t& wire) {
  wire.type = body_t::SPHERE;
  std::copy_n(sphere.center_C.data(), 3, wire.center_m);
  wire.radius_m = sphere.radius_m;
}

void fill(const motion::ConvexShape& convex, body_t& wire) {
  wire.type = body_t::CONVEX;
  for (const std::vector<Vec3>& piece : convex.pieces_C) {
    wire.piece_sizes.push_back(static_cast<std::int32_t>(piece.size()));
    add_points(piece, wire);
  }
  wire.num_pieces = static_cast<std::int32_t>(wire.piece_sizes.size());
}

void fill(const motion::MeshShape& mesh, body_t& wire) {
  wire.type = body_t::MESH;
  add_points(mesh.vertices_C, wire);
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
    wire.triangles.push_back({static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
                              static_cast<std::int32_t>(t[2])});
  }
  wire.num_triangles = static_cast<std::int32_t>(wire.triangles.size());
}

base::Result<std::optional<BodyShape>> convex_of(const body_t& wire) {
  motion::ConvexShape convex;
  std::size_t next = 0;
  for (std::size_t i = 0; i < wire.piece_sizes.size(); ++i) {
    const std::int32_t size = wire.piece_sizes[i];
    if (size < 0 || static_cast<std::size_t>(size) > wire.points_m.size() - next) {
      return base::Failure{"body.piece_sizes[" + std::to_string(i) + "]: is " +
                           std::to_string(size) + ", and " +
                           std::to_string(wire.points_m.size() - next) + " points are left"};
    }
    std::vector<Vec3>& piece = convex.pieces_C.emplace_back();
    for (std::int32_t k = 0; k < size; ++k) piece.push_back(vec3(wire.points_m[next++]));
  }
  if (next < wire.points_m.size()) {
    return base::Failure{"body.piece_sizes: " + std::to_string(wire.points_m.size() - next) +
                         " points belong to no piece"};
  }
  return std::optional<BodyShape>(std::move(convex));
}

base::Result<std::optional<BodyShape>> mesh_of(const body_t& wire) {
  motion::MeshShape mesh;
  for (const std::vector<double>& point : wire.points_m) mesh.vertices_C.push_back(vec3(point));
  for (std::size_t i = 0; i < wire.triangles.size(); ++i) {
    std::array<std::uint32_t, 3>& triangle = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t vertex = wire.triangles[i][k];
      if (vertex < 0) {
        return base::Failure{"body.triangles[" + std::to_string(i) + "][" + std::to_string(k) +
                             "]: is " + std::to_string(vertex) + ", which is below 0"};
      }
      triangle[k] = static_cast<std::uint32_t>(vertex);
    }
  }
  return std::optional<BodyShape>(std::move(mesh));
}

/// Returns the first member that is not zero or empty though the type does not use it: its sender
/// meant it.
std::string idle_member(const body_t& wire) {
  const bool is_box = wire.type == body_t::BOX;
  const bool is_sphere = wire.type == body_t::SPHERE;
  const bool is_convex = wire.type == body_t::CONVEX;
  const bool is_mesh = wire.type == body_t::MESH;
  std::string_view idle;
  if (!is_box && !is_sphere && !is_zero(wire.center_m)) idle = "center_m";
  if (!is_box && !is_zero(wire.size_m)) idle = "size_m";
  if (!is_sphere && wire.radius_m != 0.0) idle = "radius_m";
  if (!is_convex && !wire.piece_sizes.empty()) idle = "piece_sizes";
  if (!is_convex && !is_mesh && !wire.points_m.empty()) idle = "points_m";
  if (!is_mesh && !wire.triangles.empty()) idle = "triangles";
  if (idle.empty()) return {};
  return "body." + std::string(idle) + ": does not count with this body.type; leave it " +
         "zero or empty, or set the type that it belongs to";
}

}  // namespace

body_t wire_body(const motion::BodyShape& shape) {
  body_t wire{};
  std::visit([&](const auto& part) { fill(part, wire); }, shape);
  return wire;
}

base::Result<std::optional<BodyShape>> body_of(const body_t& wire) {
  const bool is_known = wire.type >= body_t::CAMERA && wire.type <= body_t::MESH;
  if (std::string error = is_known ? idle_member(wire) : ""; !error.empty()) {
    return base::Failure{std::move(error)};
  }
  switch (wire.type) {
    case body_t::CAMERA:
      return std::optional<BodyShape>();
    case body_t::BOX:
      return std::optional<BodyShape>(motion::BoxShape{vec3(wire.center_m), vec3(wire.size_m)});
    case body_t::SPHERE:
      return std::optional<BodyShape>(motion::SphereShape{vec3(wire.center_m), wire.radius_m});
    case body_t::CONVEX:
      return convex_of(wire);
    case body_t::MESH:
      return mesh_of(wire);
    default:
      return base::Failure{"body.type: " + std::to_string(wire.type) + " is unknown"};
  }
}

}  // namespace camway::messages
