// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// Returns a pose with the same orientation, reached by a free straight motion, at which a ball
/// about the centre of the body is free: `pose` itself if the ball is free there. Searches for a
/// ball start and end there, as a body that is free may be nearer to obstacles than its ball.
///
/// Tries 26 directions at six distances, nearer ones first. Returns nothing if none will do.
std::optional<motion::SignedPose> ball_escape(FreeSpace& space, const motion::SignedPose& pose,
                                              double ball_radius_m);

}  // namespace camway::correction
