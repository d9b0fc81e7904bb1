// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "daemon/collision/obstacles.h"
#include "daemon/geometry/types.h"

namespace camway::correction {

/// A plane of the scene, or a side of the bounds, that a ball is in front of.
struct Wall {
  geometry::Vec3 normal;  ///< unit vector towards the ball
  double at_m = 0.0;      ///< `normal` · x of every point of the plane

  [[nodiscard]] double height_m(const geometry::Vec3& point_W) const {
    return normal.dot(point_W) - at_m;
  }
};

/// One wall without holes, or the corner that up to three walls make.
struct ClosedCorner {
  static constexpr std::size_t kMostWalls = 3;
  std::array<Wall, kMostWalls> walls;
  std::size_t count = 0;  ///< of `walls`, at least 1

  [[nodiscard]] bool is_before_all(const geometry::Vec3& point_W) const {
    return std::all_of(walls.begin(), walls.begin() + static_cast<std::ptrdiff_t>(count),
                       [&](const Wall& wall) { return wall.height_m(point_W) > 0.0; });
  }
};

/// Returns the corner if a ball of radius `keep_m`, whose centre moves from `from_W` within `box`,
/// meets nothing else. Then the ball can reach only the convex part of the box in front of the
/// walls, and nothing behind them. Walls nearly parallel to each other make no corner, as the space
/// between them may lead on.
///
/// A wall is a set of triangles within `keep_m` of one plane. Every part of their edges that lies
/// in the box and in front of the other walls must be closed: within `keep_m` of another triangle
/// that continues the wall beyond the edge or belongs to another wall. So a wall may stand on a
/// floor without sharing vertices with it. A side of the bounds that cuts the box is a wall without
/// edges.
///
/// For searches, not for proofs: rounded, and nothing where it would take long to tell.
std::optional<ClosedCorner> closed_corner(const collision::Obstacles& obstacles,
                                          const geometry::Box& box, const geometry::Vec3& from_W,
                                          double keep_m);

}  // namespace camway::correction
