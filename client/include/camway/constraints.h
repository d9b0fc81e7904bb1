// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

namespace camway {

/// What a corrected path is improved for, while it stays proved free.
enum class Objective {
  kClosest,    ///< to the path as interpolated
  kShortest,   ///< way of the eye
  kSmoothest,  ///< least bending energy
  kSafest,     ///< furthest from the scene
};

/// What corrections may do to the orientation of the camera. Given keyframes are kept in any case.
///
///     request.orientation = camway::Orientation::level({0, 1, 0});
struct Orientation {
  enum class Policy {
    kFree,    ///< turn it as needed
    kKeep,    ///< at every time as on the path as interpolated
    kLevel,   ///< turn it, but do not tilt its horizon, the line across `up`, more than it was
    kTarget,  ///< turn it, but keep `target_m` within `cone_rad` of the view, or as close as it was
  };

  Policy policy = Policy::kFree;
  std::array<double, 3> up{};        ///< of any length; all zero for the default, Y
  std::array<double, 3> target_m{};  ///< in the world frame
  double cone_rad = 0.0;             ///< half angle [Limit: 0 < value <= π; 0 for the default]
  /// Most that the camera may be turned from how it would be on the path as interpolated.
  /// [Limit: 0 <= value <= π]
  std::optional<double> max_turn_rad;

  static Orientation keep() {
    Orientation orientation;
    orientation.policy = Policy::kKeep;
    return orientation;
  }
  static Orientation level(const std::array<double, 3>& up) {
    Orientation orientation;
    orientation.policy = Policy::kLevel;
    orientation.up = up;
    return orientation;
  }
  static Orientation target(const std::array<double, 3>& target_m, double cone_rad = 0.0) {
    Orientation orientation;
    orientation.policy = Policy::kTarget;
    orientation.target_m = target_m;
    orientation.cone_rad = cone_rad;
    return orientation;
  }
};

/// Limits that the path is to meet. 0: no limit.
struct MotionLimits {
  double speed_m_per_s = 0.0;
  double acceleration_m_per_s2 = 0.0;
  double turn_rate_rad_per_s = 0.0;
  /// Whether the path may be slowed to meet them; else a path that breaks them is not `ok`.
  bool may_retime = false;
};

/// A box along the axes of the world that no point of the body may leave. A side without a number
/// is no limit.
struct Bounds {
  std::array<std::optional<double>, 3> min_m{};
  std::array<std::optional<double>, 3> max_m{};
};

}  // namespace camway
