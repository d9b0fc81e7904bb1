// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/correction/path/free_space.h"
#include "daemon/correction/path/pocket.h"
#include "daemon/correction/search/cell_options.h"

namespace camway::correction {

struct CellResult {
  /// The way from begin to end, both included; empty if none was found.
  std::vector<geometry::Vec3> way_W;
  /// Whether everything reachable from one end through cells of the smallest size was looked at,
  /// without the other end in it.
  bool exhausted = false;
  /// The region that shuts in one end, if `exhausted`. If the cells ran out, the region that was
  /// reached from an end in a narrow place, or from one with much less space than the other. If
  /// there is a way, the region that was reached from an end in a narrow place before the way out
  /// of it was found: the body may be too large for that. Else nothing.
  std::optional<Pocket> pocket;
  std::size_t cells = 0;  ///< number of cells looked at
};

/// Finds a way for a ball by approximate cell decomposition (Brooks & Lozano-Pérez 1985; lazily, as
/// Zhu & Latombe 1991): a cube around the scene is divided into eight, recursively, where it is
/// neither proved free for the centre of the ball nor proved to be of no use. Finding a way through
/// a small hole costs at most in proportion to the area of the walls; an equally fine lattice costs
/// the volume of the rooms.
///
/// The regions reached from the two ends grow alternately. Beside them the largest cells are
/// divided first, and those far from the straight line between the ends later (deviation: the cited
/// methods divide along a guessed way). So if one end is shut in, the search ends when its pocket
/// is known, however large the rest is. A cell at a wall or in a corner that is closed
/// (`closed_corner.h`) is not divided: its free part leads nowhere that its neighbours do not, so a
/// bare wall costs the length of its edges and not its area.
///
/// A narrow place, such as the inside of a hollow wall, may extend through a whole building. Its
/// walls are then too many to be searched for small holes, so the search of it ends sooner.
///
/// The way is the cheapest one through the free cells that are known at the end of the search; room
/// lowers the cost. It connects the centres of adjacent free cells, so it is free as far as
/// computed distances are right. Deterministic, unless the deadline strikes. Requires the ball to
/// be free at both ends.
CellResult cell_way(const FreeSpace& space, const geometry::Vec3& from_W,
                    const geometry::Vec3& to_W, const CellOptions& options,
                    const base::Deadline& deadline);

}  // namespace camway::correction
