// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "daemon/geometry/types.h"

namespace camway::correction {

/// Returns the length of a polyline.
inline double length_m(std::span<const geometry::Vec3> way_W) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < way_W.size(); ++i) sum_m += (way_W[i] - way_W[i - 1]).norm();
  return sum_m;
}

}  // namespace camway::correction
