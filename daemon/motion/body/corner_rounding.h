// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/segment.h"

namespace camway::motion {

/// Rounding of the position by de Casteljau: 3 levels of 3 roundings relative to the largest
/// coordinate, and the final sum with the rotated corner. A factor of sqrt(3) from coordinates to
/// length makes 18 units of rounding of the longest control point; a unit is half this epsilon.
inline constexpr double kEyeRounding = 12.0 * std::numeric_limits<double>::epsilon();

/// Rounding of the orientation by de Casteljau: 6 levels of 3 roundings, a factor of 2 from
/// coordinates to length: 36 units of the longest control point. As an angle, relative to the
/// numerator's own length, at most pi/2 times that, and a corner moves by twice the angle times its
/// radius: 116 units.
inline constexpr double kTurnRounding = 64.0 * std::numeric_limits<double>::epsilon();

/// Rounding of the division by the length (a quaternion within 5 units of unit length), of the
/// rotation matrix (30 units an entry) and of its product with the corner: fewer than 110 units of
/// the corner's radius.
inline constexpr double kRotationRounding = 60.0 * std::numeric_limits<double>::epsilon();

/// Bound of the distance between a corner that `corners_W(corners_C, pose_at(segment, u))` computes
/// and its place by exact arithmetic on the same numbers. It holds for all points of the filled
/// quadrilateral, as each is the same convex combination of corners. Infinite if the orientation's
/// numerator is too close to zero. [Units: metres]
double corner_rounding_m(const Segment& segment, double u, double body_radius_m);

}  // namespace camway::motion
