// SPDX-License-Identifier: MIT
#include "daemon/motion/body/camera.h"

#include <algorithm>
#include <cmath>

namespace camway::motion {

Corners near_corners_C(const Camera& camera) {
  const double x = camera.near_m * std::tan(camera.fov_x_rad / 2.0);
  const double y = camera.near_m * std::tan(camera.fov_y_rad / 2.0);
  const double z = -camera.near_m;
  return {{{x, y, z}, {-x, y, z}, {-x, -y, z}, {x, -y, z}}};
}

Corners corners_W(const Corners& corners_C, const Pose& pose) {
  const Eigen::Matrix3d R_WC = pose.orientation.toRotationMatrix();
  Corners result;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = R_WC * corners_C[i] + pose.position;
  return result;
}

double body_radius_m(const Corners& corners_C) {
  double radius_m = 0.0;
  for (const geometry::Vec3& corner : corners_C) radius_m = std::max(radius_m, corner.norm());
  return radius_m;
}

}  // namespace camway::motion
