// SPDX-License-Identifier: MIT
#include "client/messages/body.h"

#include <algorithm>

#include "lcmtypes/wire/layout.h"

namespace camway {
namespace {

std::optional<std::string> fault_in_count(const std::string& field, std::size_t count,
                                          std::size_t most) {
  if (count <= most) return std::nullopt;
  return field + ": there are " + std::to_string(count) + ", at most " + std::to_string(most) +
         " are allowed";
}

std::int8_t wire_type(Body::Shape shape) {
  switch (shape) {
    case Body::Shape::kCamera:
      return body_t::CAMERA;
    case Body::Shape::kBox:
      return body_t::BOX;
    case Body::Shape::kSphere:
      return body_t::SPHERE;
    case Body::Shape::kConvex:
      return body_t::CONVEX;
    case Body::Shape::kMesh:
      return body_t::MESH;
  }
  return -1;  // the daemon refuses it by name
}

void add_points(const std::vector<Body::Point>& points, body_t& wire) {
  for (const Body::Point& point : points) wire.points_m.emplace_back(point.begin(), point.end());
  wire.num_points = static_cast<std::int32_t>(wire.points_m.size());
}

}  // namespace

std::optional<std::string> fault_in_form(const Body& body) {
  if (body.shape == Body::Shape::kConvex) {
    // An empty piece takes room in the message, too.
    if (auto fault = fault_in_count("body.pieces_m", body.pieces_m.size(), wire::kMaxBodyPoints)) {
      return fault;
    }
    std::size_t count = 0;
    for (const auto& piece : body.pieces_m) count += piece.size();
    return fault_in_count("points in body.pieces_m", count, wire::kMaxBodyPoints);
  }
  if (body.shape != Body::Shape::kMesh) return std::nullopt;
  if (auto fault =
          fault_in_count("body.vertices_m", body.vertices_m.size(), wire::kMaxBodyPoints)) {
    return fault;
  }
  return fault_in_count("body.triangles", body.triangles.size(), wire::kMaxBodyTriangles);
}

body_t to_wire(const Body& body) {
  body_t wire{};
  wire.type = wire_type(body.shape);
  std::copy(body.center_m.begin(), body.center_m.end(), wire.center_m);
  std::copy(body.size_m.begin(), body.size_m.end(), wire.size_m);
  wire.radius_m = body.radius_m;
  if (body.shape == Body::Shape::kConvex) {
    for (const auto& piece : body.pieces_m) {
      wire.piece_sizes.push_back(static_cast<std::int32_t>(piece.size()));
      add_points(piece, wire);
    }
    wire.num_pieces = static_cast<std::int32_t>(wire.piece_sizes.size());
  } else if (body.shape == Body::Shape::kMesh) {
    add_points(body.vertices_m, wire);
    for (const auto& t : body.triangles) wire.triangles.emplace_back(t.begin(), t.end());
    wire.num_triangles = static_cast<std::int32_t>(wire.triangles.size());
  }
  return wire;
}

}  // namespace camway
