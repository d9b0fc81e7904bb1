// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// A free pose near a colliding one, with the same orientation.
struct FreePose {
  motion::Pose pose;
  double moved_m = 0.0;  ///< length of the translation
};

/// A further condition on a free pose: returns whether it holds.
using PoseRule = std::function<bool(const motion::Pose&)>;

/// Returns approximately the nearest free pose that satisfies `will_do` and has the orientation of
/// `pose`. The pose keeps `margin_m` beyond the required clearance, so that a path can leave it.
///
/// Shells of directions grow about `pose` until one holds such a pose, so no side is preferred.
/// Then the translation is shortened, and its direction varied. Of translations whose lengths
/// differ by less than `kFreePosePrecision`, the one that leads to the larger gap is taken. A pose
/// beyond the bounds is first moved by the shortest translation into them; if it is not free there,
/// the shells grow from there.
///
/// Returns nothing if no shell within `kFreePoseReach` radii of the ball about the body holds such
/// a pose. May miss a free region that is narrower than the spacing of the shells. If the deadline
/// strikes, returns the best pose so far, or nothing.
/// [Limit: 0 <= margin_m]
std::optional<FreePose> nearest_free_pose(FreeSpace& space, const motion::Pose& pose,
                                          double margin_m, const PoseRule& will_do,
                                          const base::Deadline& deadline = base::Deadline::never());

inline constexpr double kFreePosePrecision = 0.02;  ///< share of the translation
inline constexpr double kFreePoseReach = 20.0;      ///< radii of the ball about the body

}  // namespace camway::correction
