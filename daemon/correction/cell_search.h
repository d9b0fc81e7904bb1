// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "daemon/correction/free_space.h"

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
  /// All that can be reached through cells of the smallest size was looked at.
  bool exhausted = false;
  std::size_t cells = 0;  ///< that were looked at
};

/// A way for a ball by approximate cell decomposition (Brooks & Lozano-Pérez 1985; lazily, as Zhu &
/// Latombe 1991): a cube around the scene is divided into eight, again and again, where it is
/// neither proved free for the middle of the ball nor proved to be of no use. Through walls with
/// small holes this finds a way at the cost of the walls' area, where a lattice as fine takes the
/// volume of the rooms.
///
/// What can be reached from the begin grows; next to it the largest cells are divided first, those
/// further from the straight way to the end later (deviation: the cited methods divide along a way
/// that is guessed). Of the free cells then known the way takes those with more room where it can.
/// It leads from the middle of a free cell to that of the next, so it is free as far as distances
/// are computed right. Deterministic, unless the deadline strikes.
/// Precondition: the ball is free at both ends.
CellResult cell_way(const FreeSpace& space, const geometry::Vec3& from_W,
                    const geometry::Vec3& to_W, const CellOptions& options,
                    const collision::Deadline& deadline);

}  // namespace camway::correction
