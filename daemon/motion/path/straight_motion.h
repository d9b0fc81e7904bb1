// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/path/segment.h"

namespace camway::motion {

/// A pose whose quaternion has a definite sign, which selects one of the two ways to turn between
/// two poses. A value type.
struct SignedPose {
  geometry::Vec3 position = geometry::Vec3::Zero();
  geometry::Vec4 orientation = geometry::Vec4::UnitX();  ///< w, x, y, z
};

/// The motion from `from` to `to` in the time [0, 1]: the position moves along the line at constant
/// speed, the orientation along the arc between the two signed quaternions. Requires that the
/// quaternions are not opposite.
Segment straight_motion(const SignedPose& from, const SignedPose& to);

/// The pose at `u` in [0, 1] of that motion.
SignedPose between(const SignedPose& from, const SignedPose& to, double u);

inline SignedPose signed_pose(const Pose& pose) {
  return {pose.position, geometry::wxyz(pose.orientation)};
}
inline Pose unsigned_pose(const SignedPose& pose) {
  return {pose.position, geometry::from_wxyz(pose.orientation)};
}
/// Returns the pose with the sign whose quaternion is nearer to that of `other`.
SignedPose signed_like(const Pose& pose, const SignedPose& other);

}  // namespace camway::motion
