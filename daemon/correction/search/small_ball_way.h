// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/correction/search/cell_search.h"

namespace camway::correction {

/// Searches a way between two poses of the body for a ball that is smaller than the body
/// (`cell_search.h`), with options that suit the size of the body. The ball is `ball_share` times
/// as large as the one that holds the body in every orientation.
///
/// The way joins the centres of the body at the two poses. The ball may collide near them, where
/// the body itself is free (`ball_escape.h`). Returns an empty result if the ball finds no free
/// place near a pose. Requires the body to be free at both poses.
CellResult small_ball_way(FreeSpace& space, const motion::SignedPose& from,
                          const motion::SignedPose& to, double ball_share, std::size_t max_cells,
                          const base::Deadline& deadline);

}  // namespace camway::correction
