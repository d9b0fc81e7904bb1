// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

/// Hamilton's algebra on four-vectors (w, x, y, z) that need not have unit length: the values of
/// Bernstein polynomials, for which Eigen's quaternion type has no sum and no scaling.
namespace camway::motion::quaternion {

/// The Hamilton product a·b.
inline geometry::Vec4 multiply(const geometry::Vec4& a, const geometry::Vec4& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

inline geometry::Vec4 conjugate(const geometry::Vec4& a) { return {a[0], -a[1], -a[2], -a[3]}; }

}  // namespace camway::motion::quaternion
