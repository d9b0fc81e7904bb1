// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// A vertex and a face, or two edges, of the body and of the scene that are near one another. To
/// first order, the gap of the pair grows by `away_W · v` if the point `at_W` of the body moves by
/// v.
struct NearPair {
  geometry::Vec3 at_W;    ///< the point of the body
  geometry::Vec3 away_W;  ///< unit vector from the scene to the body
  double gap_m = 0.0;     ///< distance less the distance at which the body collides
};

/// Returns the pairs of the body at `pose` with a gap below `horizon_m`, the least gaps first, at
/// most `kMostPairs` of them. Where thousands of triangles of a large body are near, the horizon is
/// halved until they are fewer. The least gap is that of the body, as computed. Only triangles of
/// the scene count, not the bounds. Requires the body to be free at `pose`.
std::vector<NearPair> near_pairs(FreeSpace& space, const motion::Pose& pose, double horizon_m);

inline constexpr std::size_t kMostPairs = 256;

}  // namespace camway::correction
