// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <numbers>

#include "daemon/geometry/types.h"
#include "daemon/motion/timing/rate_limits.h"

namespace camway::correction {

/// The quantity that a corrected path is improved for while it stays proved free.
enum class Objective : std::uint8_t {
  kClosest,    ///< shift from the interpolated path, and acceleration (`closeness_cost`)
  kShortest,   ///< length of the curve of the eye
  kSmoothest,  ///< bending energy
  kSafest,     ///< least distance to the scene
};

/// Whether the objective is a measure of the curve of the eye alone. Paths of other objectives keep
/// room beside what they pass.
inline bool measures_curve(Objective objective) {
  return objective == Objective::kShortest || objective == Objective::kSmoothest;
}

/// Changes of orientation that corrections may make (`orientation_rule.h` defines them exactly).
/// The rule holds at every time, relative to the interpolated path at the same time.
enum class OrientationRule : std::uint8_t {
  kFree,  ///< any turn
  kKeep,  ///< none: the orientation stays as on the interpolated path
  /// Turns after which the horizon is nowhere more tilted than on the interpolated path.
  kLevel,
  /// Turns after which the target is nowhere outside of a cone about the direction of view, or
  /// nowhere farther outside than on the interpolated path.
  kTarget,
};

/// The orientation rule and its parameters. The policy binds the parts of the path that the ladder
/// changes. Given keyframes keep their orientation.
struct OrientationPolicy {
  OrientationRule rule = OrientationRule::kFree;
  /// For kLevel: the up direction, unit length. The default Y is up in the camera's own frame, so
  /// the identity orientation is level.
  geometry::Vec3 up_W = geometry::Vec3::UnitY();
  geometry::Vec3 target_W = geometry::Vec3::Zero();  ///< for kTarget: the target
  double cone_rad = 0.5;  ///< for kTarget: half angle of the cone [Limit: 0 < value <= pi]
  /// Largest angle from the orientation on the interpolated path at the same time.
  /// [Limit: 0 <= value <= pi]
  double max_turn_rad = std::numbers::pi;

  bool operator==(const OrientationPolicy&) const = default;
};

/// Whether the policy allows any change of orientation.
inline bool may_turn_in(const OrientationPolicy& policy) {
  return policy.rule != OrientationRule::kKeep && policy.max_turn_rad > 0.0;
}

/// Smallest visible turn: a fifth of a pixel, in a picture 2,000 pixels wide with a field of view
/// of 60 degrees.
inline constexpr double kLeastTurn_rad = 1e-4;

/// Returns the policy with an invisible limit of turning set to 0. Searches gain nothing by such
/// turns, and take a hundred times as long.
inline OrientationPolicy without_unseen_turns(OrientationPolicy policy) {
  if (policy.max_turn_rad < kLeastTurn_rad) policy.max_turn_rad = 0.0;
  return policy;
}

/// Whether the policy restricts changes of orientation.
inline bool is_limited(const OrientationPolicy& policy) {
  return policy.rule != OrientationRule::kFree || policy.max_turn_rad < std::numbers::pi;
}

/// Limits of speed, acceleration and turn rate for the whole path.
struct MotionLimits : motion::RateLimits {
  /// Whether the path may be slowed to meet the limits; otherwise a path that breaks them is not
  /// `ok`.
  bool may_retime = false;

  bool operator==(const MotionLimits&) const = default;
};

}  // namespace camway::correction
