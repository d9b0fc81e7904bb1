// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

/// Checks that an import could have made the vertices and triangles of `mesh`: there are triangles,
/// their vertices exist, all coordinates are within geometry::kLargestCoordinate_m, and each
/// triangle has a non-zero area in exact arithmetic. Returns the bounds of the triangles, or the
/// fault. Does not check `mesh.objects`. Runs on `threads` threads. [Limit: threads >= 1]
base::Result<geometry::Box> checked_bounds(const Mesh& mesh, unsigned threads);

/// Returns the first of these faults, or an empty text: a coordinate that is not within
/// geometry::kLargestCoordinate_m, and a triangle with a vertex that does not exist. Unlike
/// `checked_bounds`, accepts the mesh of any shape: rounding takes the area of triangles of the
/// smallest ones, and a point cloud without points has no triangles. Does not check `mesh.objects`.
/// Runs on `threads` threads. [Limit: threads >= 1]
std::string fault_in_numbers(const Mesh& mesh, unsigned threads);

}  // namespace camway::scene
