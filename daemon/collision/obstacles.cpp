// SPDX-License-Identifier: MIT
#include "daemon/collision/obstacles.h"

#include "daemon/scene/snapshot/snapshot.h"

namespace camway::collision {

Obstacles::Obstacles(const scene::Snapshot& snapshot)
    : index(snapshot.index),
      field(snapshot.field.get()),
      solids(snapshot.solids.get()),
      bounds(snapshot.options.bounds),
      surface_error_m(snapshot.report.surface_error_m) {}

geometry::Vec3 Obstacles::normal_W(std::uint32_t number) const {
  if (is_side(number)) return geometry::Bounds::inward(side_of(number));
  const geometry::Triangle triangle = index.triangle(number);
  return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
}

}  // namespace camway::collision
