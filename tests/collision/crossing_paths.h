// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"
#include "tests/collision/crossing_random.h"

namespace camway::testing {

/// A camera from a near distance of 1 mm to 1 m, 20° to 120° wide.
motion::Camera random_camera(CaseRandom& random);

/// Where a path begins: at the origin, somewhere within a kilometre, or 10⁶ m away.
geometry::Vec3 random_place(CaseRandom& random);

enum class PathKind {
  kStraight,  ///< uniform, without turning
  kSpin,      ///< turns on the spot, at up to 170°
  kSmooth,    ///< the interpolating path through three or four keyframes
  kFree,      ///< two segments of random control points, that turn by up to a right angle
};

/// Segment `i` lasts from second `i` to second `i + 1`, so that times and parameters convert
/// without rounding.
motion::Path random_path(CaseRandom& random, PathKind kind, const geometry::Vec3& place_W,
                         double size_m);

/// A uniform straight motion from pose to pose in one second, without turning.
motion::Path uniform_path(const motion::Pose& from, const geometry::Vec3& to_W);

/// A turn on the spot about an axis of the camera, in one second.
motion::Path turning_path(const motion::Pose& from, const geometry::Vec3& axis_C, double angle_rad);

}  // namespace camway::testing
