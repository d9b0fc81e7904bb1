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
#include "daemon/motion/spline/interpolate.h"

namespace camway::motion::test {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;

inline constexpr double kEpsilon = 2.220446049250313e-16;

/// Random data from a fixed seed, which a test prints.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {
    // Do not print while test parameters are made: a list of tests must hold names only.
    if (testing::UnitTest::GetInstance()->current_test_info() == nullptr) return;
    std::printf("[   SEED   ] %llu\n", static_cast<unsigned long long>(seed));
  }

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1.0p-53);
  }
  /// Returns a normal number by the Box-Muller transform: std::normal_distribution differs between
  /// libraries.
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
    return radius * std::cos(uniform(0.0, 6.283185307179586));
  }
  /// Returns a number between `low` and `high` whose logarithm is uniformly distributed.
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool coin() { return integer(0, 1) == 1; }
  Vec3 vector(double scale) { return {scale * normal(), scale * normal(), scale * normal()}; }
  Quat rotation() { return Quat(normal(), normal(), normal(), normal()).normalized(); }
  Vec4 unit_four_vector() { return geometry::wxyz(rotation()); }

 private:
  std::mt19937_64 engine_;
};

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
  for (int i = 0; i < count; ++i) poses.push_back({random.vector(scale_m), random.rotation()});
  return poses;
}

/// Returns an arbitrary segment whose orientation control points are within about `spread` of one
/// direction.
inline Segment random_segment(Random& random, double spread) {
  Segment segment;
  segment.t0_s = random.uniform(-10.0, 10.0);
  segment.t1_s = segment.t0_s + random.log_uniform(1e-2, 1e2);
  for (Vec3& point : segment.position) point = random.vector(2.0);
  const Vec4 direction = random.unit_four_vector();
  for (Vec4& point : segment.orientation)
    point = random.uniform(0.7, 1.4) * (direction + spread * random.unit_four_vector());
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
