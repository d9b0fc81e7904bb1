// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::geometry {

/// A half-space `normal · x <= offset`.
struct HalfSpace {
  Vec3 normal = Vec3::UnitX();  ///< unit length
  double offset_m = 0.0;
};

}  // namespace camway::geometry
