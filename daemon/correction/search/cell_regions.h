// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "daemon/correction/path/pocket.h"
#include "daemon/correction/search/cell_tree.h"

namespace camway::correction {

/// The region that was reached from an end of a way.
struct CellRegion {
  geometry::Box box_W;     ///< about its cells and the middles of those beside them that are mixed
  double unsure_m = 0.0;   ///< half the side of the largest mixed cell beside it: walls are there
  double volume_m3 = 0.0;  ///< of its cells
};

/// One of each end of a way.
template <class T>
using OfEnds = std::array<T, kCellEnds>;

/// Returns the regions that were reached from the two ends.
OfEnds<CellRegion> regions_reached(const CellTree& tree);

/// Returns for each end whether it is in a narrow place: none of the cells that were reached from
/// it has a middle with a gap of the ball of `narrow_m` or more. If `narrow_m` is 0, no place is
/// narrow.
OfEnds<bool> ends_in_narrow_places(const CellTree& tree, double narrow_m);

/// Returns the pocket that shuts in `end`, after a search that looked at everything reachable from
/// it without meeting the other end.
Pocket complete_pocket(const CellTree& tree, std::size_t end, const OfEnds<bool>& is_narrow);

/// Returns the region of the end in a narrow place, or else, if there is no way, of the end from
/// which much less was reached so far. Returns nothing if neither end is such, or if nothing was
/// reached. Requires a search that gave both ends about as many cells.
std::optional<Pocket> pocket_so_far(const CellTree& tree, const OfEnds<bool>& is_narrow,
                                    bool has_way);

}  // namespace camway::correction
