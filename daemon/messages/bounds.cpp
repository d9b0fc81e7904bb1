// SPDX-License-Identifier: MIT
#include "daemon/messages/bounds.h"

#include <cmath>

namespace camway::messages {

bounds_t wire_bounds(const geometry::Bounds& bounds) {
  bounds_t wire{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double min_m = bounds.limit_m(axis);
    const double max_m = bounds.limit_m(axis + 3);
    wire.has_min[axis] = std::isinf(min_m) ? 0 : 1;
    if (wire.has_min[axis] != 0) wire.min_m[axis] = min_m;
    wire.has_max[axis] = std::isinf(max_m) ? 0 : 1;
    if (wire.has_max[axis] != 0) wire.max_m[axis] = max_m;
  }
  return wire;
}

geometry::Bounds bounds_of(const bounds_t& wire) {
  geometry::Bounds bounds;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (wire.has_min[axis] != 0) bounds.min_W[axis] = wire.min_m[axis];
    if (wire.has_max[axis] != 0) bounds.max_W[axis] = wire.max_m[axis];
  }
  return bounds;
}

}  // namespace camway::messages
