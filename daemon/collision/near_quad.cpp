// SPDX-License-Identifier: MIT
#include "daemon/collision/near_quad.h"

namespace camway::collision {

std::array<geometry::Triangle, 2> near_quad_triangles(const motion::Corners& corners) {
  return {geometry::Triangle{corners[0], corners[1], corners[2]},
          geometry::Triangle{corners[0], corners[2], corners[3]}};
}

bool collides(const scene::SceneIndex& index, const motion::Corners& corners_C,
              const motion::Pose& pose) {
  const std::array<geometry::Triangle, 2> quad =
      near_quad_triangles(motion::corners_W(corners_C, pose));
  return index.intersects(quad[0]) || index.intersects(quad[1]);
}

std::optional<double> clearance_m(const scene::SceneIndex& index, const motion::Corners& corners_C,
                                  const motion::Pose& pose, double cutoff_m) {
  const std::array<geometry::Triangle, 2> quad =
      near_quad_triangles(motion::corners_W(corners_C, pose));
  const std::optional<scene::Nearest> nearest = index.nearest(quad, cutoff_m);
  if (!nearest) return std::nullopt;
  return nearest->distance_m;
}

}  // namespace camway::collision
