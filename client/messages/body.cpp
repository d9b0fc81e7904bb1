// SPDX-License-Identifier: MIT
#include "client/messages/body.h"

#include "client/messages/members.h"

namespace camway {
namespace {

static_assert(static_cast<int>(Body::Shape::kMesh) == body_t::MESH);

void add_points(const std::vector<Body::Point>& points, body_t& wire) {
  for (const Body::Point& point : points) wire.points_m.emplace_back(point.begin(), point.end());
}

}  // namespace

void put(const Body& mine, body_t& wire) {
  put(mine.shape, wire.type);
  put(mine.center_m, wire.center_m);
  put(mine.size_m, wire.size_m);
  wire.radius_m = mine.radius_m;
  if (mine.shape == Body::Shape::kConvex) {
    for (const auto& piece : mine.pieces_m) {
      wire.piece_sizes.push_back(static_cast<std::int32_t>(piece.size()));
      add_points(piece, wire);
    }
  } else if (mine.shape == Body::Shape::kMesh) {
    add_points(mine.vertices_m, wire);
    for (const auto& t : mine.triangles) wire.triangles.emplace_back(t.begin(), t.end());
  }
  wire::set_counts(wire);
}

}  // namespace camway
