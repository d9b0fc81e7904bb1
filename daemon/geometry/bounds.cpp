// SPDX-License-Identifier: MIT
#include "daemon/geometry/bounds.h"

#include <cmath>

namespace camway::geometry {
namespace {

constexpr std::array<const char*, Bounds::kSides> kFields = {"min[0]", "min[1]", "min[2]",
                                                             "max[0]", "max[1]", "max[2]"};

}  // namespace

OptionalBounds optional_bounds_of(const Bounds& bounds) {
  OptionalBounds limits;
  for (std::size_t side = 0; side < Bounds::kSides; ++side) {
    if (std::isinf(bounds.limit_m(side))) continue;
    (side < 3 ? limits.min_m : limits.max_m)[side % 3] = bounds.limit_m(side);
  }
  return limits;
}

Bounds bounds_of(const OptionalBounds& limits) {
  Bounds bounds;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (limits.min_m[axis]) bounds.min_W[static_cast<Eigen::Index>(axis)] = *limits.min_m[axis];
    if (limits.max_m[axis]) bounds.max_W[static_cast<Eigen::Index>(axis)] = *limits.max_m[axis];
  }
  return bounds;
}

std::optional<BoundsFault> fault_in(const Bounds& bounds) {
  for (std::size_t side = 0; side < Bounds::kSides; ++side) {
    const double value_m = bounds.limit_m(side);
    if (std::isnan(value_m)) return BoundsFault{kFields[side], "is not a number"};
    if (std::isfinite(value_m) && std::abs(value_m) > kMaxBound_m)
      return BoundsFault{kFields[side], "is more than 1e9 m from the origin"};
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (bounds.limit_m(axis) < bounds.limit_m(axis + 3)) continue;
    return BoundsFault{kFields[axis],
                       std::string("is not below ") + kFields[axis + 3] + ": no room is left"};
  }
  return std::nullopt;
}

}  // namespace camway::geometry
