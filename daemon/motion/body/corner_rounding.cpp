// SPDX-License-Identifier: MIT
#include "daemon/motion/body/corner_rounding.h"

#include <algorithm>
#include <limits>

namespace camway::motion {

double corner_rounding_m(const Segment& segment, double u, double body_radius_m) {
  double longest_position_m = 0.0;
  for (const geometry::Vec3& point : segment.position) {
    longest_position_m = std::max(longest_position_m, point.norm());
  }
  double longest_orientation = 0.0;
  for (const geometry::Vec4& point : segment.orientation) {
    longest_orientation = std::max(longest_orientation, point.norm());
  }
  // The computed length may itself be off by the error; half of it is a safe floor as long as the
  // error is less than that.
  const double length = orientation_numerator_at(segment, u).norm();
  const double turn = kTurnRounding * longest_orientation;
  if (!(length > 4.0 * turn)) return std::numeric_limits<double>::infinity();
  return kEyeRounding * (longest_position_m + body_radius_m) +
         body_radius_m * (2.0 * turn / length + kRotationRounding);
}

}  // namespace camway::motion
