// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <span>
#include <vector>

#include "daemon/motion/path/quaternion.h"
#include "daemon/motion/spline/derive_times.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/random.h"

namespace camway::motion::test {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;

inline constexpr double kEpsilon = 2.220446049250313e-16;

using testing::Random;

inline Quat turned(const Vec3& axis, double angle_rad) {
  return Quat(Eigen::AngleAxisd(angle_rad, axis.normalized()));
}

inline std::vector<Keyframe> with_times(const std::vector<Pose>& poses) {
  const std::vector<double> times_s = derive_times_s(poses);
  std::vector<Keyframe> keyframes;
  for (std::size_t i = 0; i < poses.size(); ++i)
    keyframes.push_back({times_s[i], poses[i], KeyframeOrigin::kGiven});
  return keyframes;
}

inline std::vector<Pose> random_poses(Random& random, int count, double scale_m = 3.0) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i)
    poses.push_back({random.normal_vector(scale_m), random.rotation()});
  return poses;
}

/// Returns an arbitrary segment whose orientation control points are within about `spread` of one
/// direction.
inline Segment random_segment(Random& random, double spread) {
  Segment segment;
  segment.t0_s = random.uniform(-10.0, 10.0);
  segment.t1_s = segment.t0_s + random.log_uniform(1e-2, 1e2);
  for (Vec3& point : segment.position) point = random.normal_vector(2.0);
  const Vec4 direction = geometry::wxyz(random.rotation());
  for (Vec4& point : segment.orientation)
    point = random.uniform(0.7, 1.4) * (direction + spread * geometry::wxyz(random.rotation()));
  return segment;
}

/// Returns the angle between two rotations, given as unit quaternions (w, x, y, z) of any sign.
/// Accurate for small angles.
inline double rotation_angle_rad(const Vec4& a, const Vec4& b) {
  const Vec4 turn = quaternion::multiply(quaternion::conjugate(a), b);
  return 2.0 * std::atan2(turn.tail<3>().norm(), std::abs(turn[0]));
}
inline double rotation_angle_rad(const Quat& a, const Quat& b) {
  return rotation_angle_rad(geometry::wxyz(a), geometry::wxyz(b));
}

/// Returns the largest coordinate of the keyframes' positions, for bounds on rounding.
inline double size_m(std::span<const Keyframe> keyframes) {
  double size_m = 0.0;
  for (const Keyframe& keyframe : keyframes)
    size_m = std::max(size_m, keyframe.pose.position.norm());
  return size_m;
}

}  // namespace camway::motion::test
