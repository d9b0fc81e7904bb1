// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/path/segment.h"

namespace camway::motion {

/// A pose whose quaternion has a sign of its own, so that of the two ways to turn from one to the
/// other one is meant. A value type.
struct SignedPose {
  geometry::Vec3 position = geometry::Vec3::Zero();
  geometry::Vec4 orientation = geometry::Vec4::UnitX();  ///< w, x, y, z
};

/// From `from` to `to` within [0, 1]: the position moves along the line at constant speed, the
/// orientation along the arc between the two quaternions, as they are signed.
/// Precondition: they are not opposite.
Segment straight_motion(const SignedPose& from, const SignedPose& to);

/// The pose at `u` in [0, 1] of that motion.
SignedPose between(const SignedPose& from, const SignedPose& to, double u);

inline SignedPose signed_pose(const Pose& pose) {
  return {pose.position, geometry::wxyz(pose.orientation)};
}
inline Pose unsigned_pose(const SignedPose& pose) {
  return {pose.position, geometry::from_wxyz(pose.orientation)};
}

}  // namespace camway::motion
