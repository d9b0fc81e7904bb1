// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/geometry/types.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::correction {

/// Whether a ball of radius `keep_m` whose middle moves from `from_W` in `box` sees nothing there
/// but one wall without holes, or the corner that up to three of them make: then all that it can
/// reach in the box is the convex part in front of these, and nothing behind them. Walls nearly
/// parallel to each other make no corner, as what is between them may lead on.
///
/// A wall is triangles in one plane, to `keep_m`. Their edges are closed where, as far as they are
/// in the box and in front of the other walls, another triangle keeps within `keep_m` of them that
/// goes on in the plane or is part of another of the walls; so walls may stand on floors without
/// sharing vertices with them.
///
/// For searches, not for proofs: rounded, and false where it would take long to tell.
bool is_closed_corner(const scene::SceneIndex& index, const geometry::Box& box,
                      const geometry::Vec3& from_W, double keep_m);

}  // namespace camway::correction
