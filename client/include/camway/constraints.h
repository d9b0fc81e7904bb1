// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

namespace camway {

/// The quantity that corrections optimise. The path stays proved free of collision.
enum class Objective {
  kClosest,    ///< near to the shot as interpolated: the picture shifts least, and gently
  kShortest,   ///< least length of the eye's way
  kSmoothest,  ///< least bending energy
  kSafest,     ///< largest distance from the scene
};

/// The changes of orientation that corrections may make. The orientations of given keyframes never
/// change. Every policy compares the camera with the path as interpolated, at the same time.
///
///     request.orientation = camway::Orientation::level({0, 1, 0});
struct Orientation {
  enum class Policy {
    kFree,  ///< no restriction
    kKeep,  ///< no change of orientation
    /// The angle between the camera's x axis and the plane perpendicular to `up` is nowhere larger
    /// than on the path as interpolated at the same time. So the horizon does not tilt.
    kLevel,
    /// The angle between the direction of view and `target_m` is at most `cone_rad`, or at most the
    /// angle on the path as interpolated at the same time if that is larger.
    kTarget,
  };

  Policy policy = Policy::kFree;
  std::array<double, 3> up{};        ///< kLevel: any length, world frame; all zero for +Y
  std::array<double, 3> target_m{};  ///< kTarget: a point in the world frame
  /// kTarget: half angle of the cone. 0 stands for the default, 0.5. [Limit: 0 <= value <= π]
  /// [Units: radians]
  double cone_rad = 0.0;
  /// Largest angle between the camera and the path as interpolated at the same time; unset: no
  /// limit. Applies to every policy. [Limit: 0 <= value <= π]
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

/// Limits on the motion of the eye and on the turn rate, at every instant of the path. 0 means no
/// limit.
struct MotionLimits {
  double speed_m_per_s = 0.0;
  double acceleration_m_per_s2 = 0.0;
  double turn_rate_rad_per_s = 0.0;
  /// Whether the daemon may slow the path to meet the limits. If not, a path that breaks a limit
  /// has the status `kPartial`.
  bool may_retime = false;
};

/// A world-axis-aligned box that no point of the body may leave. A side without a value is no
/// limit.
struct Bounds {
  std::array<std::optional<double>, 3> min_m{};
  std::array<std::optional<double>, 3> max_m{};
};

}  // namespace camway
