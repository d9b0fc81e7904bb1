// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"

namespace camway::motion {

/// The pose of the camera frame C in the world frame W: `p_W = orientation * p_C + position`. The
/// camera looks down -Z with +Y up, as in OpenGL; `position` is the eye.
struct Pose {
  geometry::Vec3 position = geometry::Vec3::Zero();         ///< [Units: metres]
  geometry::Quat orientation = geometry::Quat::Identity();  ///< unit length
};

/// The source of a keyframe: the request, or a correction.
enum class KeyframeOrigin { kGiven, kInserted };

/// A pose that the path must pass through at a time.
struct Keyframe {
  double time_s = 0.0;
  Pose pose;
  KeyframeOrigin origin = KeyframeOrigin::kGiven;
  /// Whether it is a given keyframe that was moved because it collided
  /// (`PlanOptions::repair_keyframes`).
  bool is_repaired = false;
  /// The point x of the image spline (`CubicPath`) at the keyframe; zero where nothing is known of
  /// it. Counts only together with a `PathFrame`.
  geometry::Vec4 image = geometry::Vec4::Zero();
};

}  // namespace camway::motion
