// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/correction/path/free_space.h"
#include "daemon/correction/path/pocket.h"

namespace camway::correction {

struct CellOptions {
  double ball_radius_m = 0.0;
  /// Cells are not divided below this side. [Limit: value > 0]
  double smallest_m = 0.01;
  std::size_t max_cells = 200'000;
  /// From this gap on more room does not make a way better. [Limit: value > 0]
  double comfort_m = 0.1;
};

struct CellResult {
  /// From the begin to the end, both included; empty if none was found.
  std::vector<geometry::Vec3> way_W;
  /// All that can be reached from one of the ends, through cells of the smallest size, was looked
  /// at, and the other end was not among it.
  bool exhausted = false;
  std::optional<Pocket> pocket;  ///< where exhausted
  std::size_t cells = 0;         ///< that were looked at
};

/// A way for a ball by approximate cell decomposition (Brooks & Lozano-Pérez 1985; lazily, as Zhu &
/// Latombe 1991): a cube around the scene is divided into eight, again and again, where it is
/// neither proved free for the middle of the ball nor proved to be of no use. Through walls with
/// small holes this finds a way at the cost of the walls' area at most, where a lattice as fine
/// takes the volume of the rooms.
///
/// What can be reached from either end grows by turns; next to it the largest cells are divided
/// first, those further from the straight way between the ends later (deviation: the cited methods
/// divide along a way that is guessed). So where one end is shut in the search is over when its
/// pocket was looked at, however large the rest is. A cell on a wall or in a corner that is
/// closed (`closed_corner.h`) is not divided: what is free of it leads nowhere that the cells
/// beside it do not, so a bare wall costs the length of its edges and not its area. Of the free
/// cells then known the way takes those with more room where it can. It leads from the middle of a
/// free cell to that of the next, so it is free as far as distances are computed right.
/// Deterministic, unless the deadline strikes. Precondition: the ball is free at both ends.
CellResult cell_way(const FreeSpace& space, const geometry::Vec3& from_W,
                    const geometry::Vec3& to_W, const CellOptions& options,
                    const collision::Deadline& deadline);

}  // namespace camway::correction
