// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// A free pose next to one that collides, with the same orientation.
struct FreePose {
  motion::Pose pose;
  double moved_m = 0.0;  ///< every point of the body
};

/// Whether a pose will do that is free; for what a search cannot know by itself.
using PoseRule = std::function<bool(const motion::Pose&)>;

/// The nearest pose that is free, will do, and is reached without turning. Shells of directions
/// grow about `pose` until one of them holds such a pose, so no side is preferred; what was found
/// is then drawn towards `pose` as far as it gets, by the length and by the direction of the move.
/// Of moves that differ by less than the precision, one that leads to more room.
///
/// A pose that is beyond the bounds is first moved straight within them, however far that is, and
/// the shells grow from there if it is not free there. Nothing if there is none on the shells
/// within `kFreePoseReach` radii of the ball about the body. `margin_m` is kept beside the required
/// clearance, so that a path can leave it. A local search: a free place that is narrower than the
/// shells are dense may be missed.
std::optional<FreePose> nearest_free_pose(FreeSpace& space, const motion::Pose& pose,
                                          double margin_m, const PoseRule& will_do);

inline constexpr double kFreePosePrecision = 0.02;  ///< as a share of the move
inline constexpr double kFreePoseReach = 20.0;      ///< radii of the ball about the body

}  // namespace camway::correction
