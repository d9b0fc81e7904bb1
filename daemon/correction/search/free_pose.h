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

/// A further condition on a free pose, which the search cannot check by itself.
using PoseRule = std::function<bool(const motion::Pose&)>;

/// Finds about the nearest free pose that satisfies `will_do` and has the orientation of `pose`.
/// `margin_m` is kept beyond the required clearance, so that a path can leave the pose.
///
/// Shells of directions grow about `pose` until one holds such a pose, so no side is preferred. The
/// result is then improved by shortening the translation and by varying its direction. Among
/// translations whose lengths differ by less than `kFreePosePrecision`, one that leads to more room
/// is taken. A pose beyond the bounds is first moved straight to within them, however far; if it is
/// not free there, the shells grow from there.
///
/// Once the deadline has passed, no further pose is looked at, and the best so far is the result.
///
/// Returns nothing if no shell within `kFreePoseReach` radii of the ball about the body holds such
/// a pose. Local search: it may miss a free region that is narrower than the spacing of the shells.
std::optional<FreePose> nearest_free_pose(FreeSpace& space, const motion::Pose& pose,
                                          double margin_m, const PoseRule& will_do,
                                          const base::Deadline& deadline = base::Deadline::never());

inline constexpr double kFreePosePrecision = 0.02;  ///< share of the translation
inline constexpr double kFreePoseReach = 20.0;      ///< radii of the ball about the body

}  // namespace camway::correction
