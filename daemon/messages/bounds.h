// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <camway/bounds_t.hpp>

#include "daemon/geometry/bounds.h"

namespace camway::messages {

/// Converts bounds without a check; `geometry::fault_in` checks the numbers. A side at infinity is
/// no limit.
inline void translate(const geometry::Bounds& mine, bounds_t& wire) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    wire.has_min[axis] = std::isinf(mine.min_W[axis]) ? 0 : 1;
    wire.has_max[axis] = std::isinf(mine.max_W[axis]) ? 0 : 1;
    wire.min_m[axis] = wire.has_min[axis] != 0 ? mine.min_W[axis] : 0.0;
    wire.max_m[axis] = wire.has_max[axis] != 0 ? mine.max_W[axis] : 0.0;
  }
}
inline void translate(const bounds_t& wire, geometry::Bounds& mine) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (wire.has_min[axis] != 0) mine.min_W[axis] = wire.min_m[axis];
    if (wire.has_max[axis] != 0) mine.max_W[axis] = wire.max_m[axis];
  }
}

}  // namespace camway::messages
