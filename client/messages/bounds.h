// SPDX-License-Identifier: MIT
#pragma once

#include <camway/constraints.h>

#include <cstddef>

#include <camway/bounds_t.hpp>

namespace camway {

/// A side without a limit has `has_min` or `has_max` 0 in the message.
inline void convert(const Bounds& mine, bounds_t& wire) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    wire.has_min[axis] = mine.min_m[axis] ? 1 : 0;
    wire.has_max[axis] = mine.max_m[axis] ? 1 : 0;
    wire.min_m[axis] = mine.min_m[axis].value_or(0.0);
    wire.max_m[axis] = mine.max_m[axis].value_or(0.0);
  }
}
inline void convert(const bounds_t& wire, Bounds& mine) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (wire.has_min[axis] != 0) mine.min_m[axis] = wire.min_m[axis];
    if (wire.has_max[axis] != 0) mine.max_m[axis] = wire.max_m[axis];
  }
}

}  // namespace camway
