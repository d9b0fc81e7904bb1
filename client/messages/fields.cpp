// SPDX-License-Identifier: MIT
#include "client/messages/fields.h"

#include <camway/plan_request_t.hpp>

namespace camway {
namespace {

static_assert(static_cast<int>(Body::Shape::kMesh) == body_t::MESH);
static_assert(static_cast<int>(Objective::kSafest) == plan_request_t::SAFEST);
static_assert(static_cast<int>(Orientation::Policy::kTarget) == orientation_t::TARGET);

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

void put(const Bounds& mine, bounds_t& wire) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    wire.has_min[axis] = mine.min_m[axis] ? 1 : 0;
    wire.has_max[axis] = mine.max_m[axis] ? 1 : 0;
    put(mine.min_m[axis], wire.min_m[axis]);
    put(mine.max_m[axis], wire.max_m[axis]);
  }
}

void put(const Orientation& mine, orientation_t& wire) {
  static_assert(wire::lacks_only<orientation_t, Orientation>({"has_max_turn"}));
  put_common(mine, wire);
  wire.has_max_turn = mine.max_turn_rad ? 1 : 0;
}

void read(const bounds_t& wire, Bounds& mine) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (wire.has_min[axis] != 0) mine.min_m[axis] = wire.min_m[axis];
    if (wire.has_max[axis] != 0) mine.max_m[axis] = wire.max_m[axis];
  }
}

}  // namespace camway
