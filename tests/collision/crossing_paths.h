// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"
#include "tests/support/random.h"

namespace camway::testing {

/// Returns a camera with a near distance of 1 mm to 1 m and fields of view of 20° to 120°.
motion::Camera random_camera(Random& random);

/// Returns the begin of a path: the origin, a place within a kilometre, or a place 10⁶ m away.
geometry::Vec3 random_place(Random& random);

enum class PathKind {
  kStraight,  ///< uniform motion without rotation
  kSpin,      ///< rotation about the eye, up to 170°
  kSmooth,    ///< the interpolating path through three or four keyframes
  kFree,      ///< two segments of random control points, which rotate by up to a right angle
};

/// Returns a path whose segment `i` lasts from second `i` to second `i + 1`, so that times and
/// parameters convert without rounding.
motion::Path random_path(Random& random, PathKind kind, const geometry::Vec3& place_W,
                         double size_m);

/// Returns a uniform straight motion without rotation, of one second.
motion::Path uniform_path(const motion::Pose& from, const geometry::Vec3& to_W);

/// Returns a rotation about an axis through the eye, of one second.
motion::Path turning_path(const motion::Pose& from, const geometry::Vec3& axis_C, double angle_rad);

}  // namespace camway::testing
