// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <string_view>

#include "daemon/geometry/types.h"
#include "daemon/motion/timing/rate_limits.h"

namespace camway::correction {

/// What a corrected path is improved for, while it stays proved free.
enum class Objective : std::uint8_t {
  kClosest,    ///< to the path as interpolated
  kShortest,   ///< length of the way of the eye
  kSmoothest,  ///< bending energy
  kSafest,     ///< least distance to the scene
};
constexpr std::array<std::string_view, 4> names_of(Objective) {
  return {"closest", "shortest", "smoothest", "safest"};
}

/// What corrections may do to orientations; `orientation_rule.h` says what exactly. What they
/// change meets the rule at every time, compared with the interpolated path at the same time.
enum class OrientationRule : std::uint8_t {
  kFree,    ///< turn the camera
  kKeep,    ///< nothing: at every time it is oriented as on the interpolated path
  kLevel,   ///< turn it, but nowhere tilt the horizon, the line across `up_W`, more than it was
  kTarget,  ///< turn it, but nowhere look further away from a point than a cone allows, or it did
};
constexpr std::array<std::string_view, 4> names_of(OrientationRule) {
  return {"free", "keep", "level", "target"};
}

/// Given keyframes are kept in any case; the rule is for what the ladder's corrections change.
struct OrientationPolicy {
  OrientationRule rule = OrientationRule::kFree;
  /// For kLevel; unit length. Y by default, as it is up in the camera's own frame: the orientation
  /// that turns nothing is level.
  geometry::Vec3 up_W = geometry::Vec3::UnitY();
  geometry::Vec3 target_W = geometry::Vec3::Zero();  ///< for kTarget
  double cone_rad = 0.5;  ///< for kTarget: half angle of the cone [Limit: 0 < value <= pi]
  /// How far the camera may be turned from how it would be on the interpolated path at that time.
  double max_turn_rad = std::numbers::pi;  ///< [Limit: 0 <= value <= pi]

  bool operator==(const OrientationPolicy&) const = default;
};

/// Whether corrections may change any orientation.
inline bool may_turn_in(const OrientationPolicy& policy) {
  return policy.rule != OrientationRule::kKeep && policy.max_turn_rad > 0.0;
}

/// Whether there is anything that they may not do.
inline bool is_limited(const OrientationPolicy& policy) {
  return policy.rule != OrientationRule::kFree || policy.max_turn_rad < std::numbers::pi;
}

/// Limits that the path is to meet.
struct MotionLimits : motion::RateLimits {
  /// Whether the path may be slowed to meet them; else a path that breaks them is not `ok`.
  bool may_retime = false;

  bool operator==(const MotionLimits&) const = default;
};

}  // namespace camway::correction
