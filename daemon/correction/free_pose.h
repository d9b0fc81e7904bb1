// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/correction/free_space.h"

namespace camway::correction {

/// A free pose next to one that collides, with the same orientation.
struct FreePose {
  motion::Pose pose;
  double moved_m = 0.0;
};

/// The nearest free pose in any of 26 directions, about: within `kFreePosePrecision` of the least
/// move in that direction from which on the body is free. Nothing within `kFreePoseReach` times the
/// size of the body. `margin_m` is kept beside the required clearance, so that a path can leave it.
std::optional<FreePose> nearest_free_pose(FreeSpace& space, const motion::Pose& pose,
                                          double margin_m);

inline constexpr double kFreePosePrecision = 0.05;  ///< as a share of the move
inline constexpr double kFreePoseReach = 20.0;      ///< radii of the ball about the body

}  // namespace camway::correction
