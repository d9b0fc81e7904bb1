// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/correction/search/cell_tree.h"

namespace camway::correction {

/// Returns the cheapest way through the free cells that were reached, as the middles of its cells
/// from `start` to `goal`, both included. Length costs, and costs more where the gap of the ball is
/// less than `comfort_m`.
///
/// The straight way between the middles of two cells that have a face, or part of one, in common
/// stays within the two: where it steps through the face it is nearer to the middle of the smaller
/// cell than that is wide, by similar triangles. So the way is free where the cells are.
///
/// Requires `start` and `goal` to be joined by cells that were reached.
std::vector<geometry::Vec3> cheapest_way(const CellTree& tree, std::uint32_t start,
                                         std::uint32_t goal, double comfort_m);

}  // namespace camway::correction
