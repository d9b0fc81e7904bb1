// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// Returns a pose at which a ball about the centre of the body is free. It has the orientation of
/// `pose`, and a straight motion from `pose` to it is free. It is `pose` itself if the ball is free
/// there. Searches for a ball start and end at such poses, because a free body may be nearer to
/// obstacles than the radius of its ball.
///
/// Tries 26 directions at six distances, nearer ones first. Returns nothing if all fail.
/// [Limit: 0 < ball_radius_m]
std::optional<motion::SignedPose> ball_escape(FreeSpace& space, const motion::SignedPose& pose,
                                              double ball_radius_m);

}  // namespace camway::correction
