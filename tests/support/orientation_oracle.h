// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "daemon/correction/path/constraints.h"
#include "daemon/motion/path/path.h"

/// The orientation policies by the words of the documentation, in degrees and at samples. Shares no
/// code with the implementation.
namespace camway::testing {

inline double degrees_of(double rad) { return rad * 180.0 / std::numbers::pi; }

/// Returns the elevation of an axis of the camera above the horizontal plane. [Units: degrees]
inline double elevation_deg(const geometry::Quat& q, const geometry::Vec3& axis_C,
                            const geometry::Vec3& up_W) {
  return 90.0 - degrees_of(std::acos(std::clamp((q * axis_C).dot(up_W), -1.0, 1.0)));
}

inline double turn_deg(const motion::Pose& a, const motion::Pose& b) {
  return degrees_of(2.0 * std::acos(std::min(1.0, std::abs(a.orientation.dot(b.orientation)))));
}

inline double off_target_deg(const motion::Pose& pose, const geometry::Vec3& target_W) {
  const geometry::Vec3 target_C = pose.orientation.conjugate() * (target_W - pose.position);
  return degrees_of(std::acos(std::clamp(-target_C.z() / target_C.norm(), -1.0, 1.0)));
}

/// Returns by how much `now` breaks the policy beyond the documented tolerance; 0 or less if it
/// does not. [Units: degrees]
inline double breach_deg(const correction::OrientationPolicy& policy, const motion::Pose& now,
                         const motion::Pose& before) {
  using correction::OrientationRule;
  using geometry::Vec3;
  constexpr double kAllowance_deg = 0.573;  // as documented: 0.01 rad
  double worst_deg = turn_deg(now, before) - degrees_of(policy.max_turn_rad);
  if (policy.rule == OrientationRule::kKeep) {
    worst_deg = std::max(worst_deg, turn_deg(now, before));
  } else if (policy.rule == OrientationRule::kLevel) {
    const Vec3& up_W = policy.up_W;
    const double tilt_deg = std::abs(elevation_deg(now.orientation, Vec3::UnitX(), up_W));
    const double before_deg = std::abs(elevation_deg(before.orientation, Vec3::UnitX(), up_W));
    worst_deg = std::max(worst_deg, tilt_deg - before_deg - kAllowance_deg);
    const double top_deg = elevation_deg(now.orientation, Vec3::UnitY(), up_W);
    const double top_before_deg = elevation_deg(before.orientation, Vec3::UnitY(), up_W);
    worst_deg = std::max(worst_deg, std::min(0.0, top_before_deg) - top_deg - kAllowance_deg);
  } else if (policy.rule == OrientationRule::kTarget) {
    const double before_deg = off_target_deg(before, policy.target_W) + kAllowance_deg;
    worst_deg = std::max(worst_deg, off_target_deg(now, policy.target_W) -
                                        std::max(degrees_of(policy.cone_rad), before_deg));
  }
  return worst_deg;
}

/// Bound on the rounding of an arc cosine near 1. [Units: degrees]
inline constexpr double kOracleRounding_deg = 1e-5;

/// Returns the largest breach at `samples` + 1 times of [begin_s, end_s].
inline double worst_breach_deg(const correction::OrientationPolicy& policy, const motion::Path& now,
                               const motion::Path& before, double begin_s, double end_s,
                               int samples = 4000) {
  double worst_deg = -360.0;
  for (int i = 0; i <= samples; ++i) {
    const double time_s = std::lerp(begin_s, end_s, static_cast<double>(i) / samples);
    worst_deg = std::max(worst_deg, breach_deg(policy, now.pose(time_s), before.pose(time_s)));
  }
  return worst_deg;
}

/// Returns the largest angle between the two orientations at the same time.
inline double largest_turn_deg(const motion::Path& now, const motion::Path& before,
                               int samples = 4000) {
  double largest_deg = 0.0;
  for (int i = 0; i <= samples; ++i) {
    const double time_s =
        std::lerp(before.begin_s(), before.end_s(), static_cast<double>(i) / samples);
    largest_deg = std::max(largest_deg, turn_deg(now.pose(time_s), before.pose(time_s)));
  }
  return largest_deg;
}

}  // namespace camway::testing
