// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "daemon/motion/path/keyframe.h"

namespace camway::motion {

/// The part of a perspective camera that can collide: its near quadrilateral, the section of the
/// view frustum with the near clipping plane (Ptacek & Johnstone 2006, section 2).
struct Camera {
  double fov_x_rad = 0.0;  ///< full horizontal field of view [Limit: 0 < value < pi]
  double fov_y_rad = 0.0;  ///< full vertical field of view [Limit: 0 < value < pi]
  double near_m = 0.0;     ///< distance from the eye to the near plane [Limit: 0 < value]
};

/// The four corners of a near quadrilateral, in cyclic order: (+x,+y), (-x,+y), (-x,-y), (+x,-y)
/// in the camera frame. Neighbours in the array (cyclically) share an edge.
using Corners = std::array<geometry::Vec3, 4>;

/// Returns the corners in the camera frame C: `(±n·tan(fov_x/2), ±n·tan(fov_y/2), -n)`.
Corners near_corners_C(const Camera& camera);

/// Returns the same corners in the world frame for a camera at `pose`.
Corners corners_W(const Corners& corners_C, const Pose& pose);

/// Returns the largest distance of a corner from the eye. Under rotation alone no point of the body
/// moves farther than a point at this radius.
double body_radius_m(const Corners& corners_C);

}  // namespace camway::motion
