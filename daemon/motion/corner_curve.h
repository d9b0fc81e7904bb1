// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "daemon/motion/segment.h"

namespace camway::motion {

/// A rational Bézier curve of degree 15: control points `(w·x, w·y, w·z, w)`.
struct RationalCurve {
  std::array<geometry::Vec4, 16> homogeneous;

  [[nodiscard]] geometry::Vec3 point_at(double u) const;
};

/// The exact curve `P(t) + R(q(t))·corner_C` that a point fixed to the camera follows on `segment`.
RationalCurve corner_curve(const Segment& segment, const geometry::Vec3& corner_C);

}  // namespace camway::motion
