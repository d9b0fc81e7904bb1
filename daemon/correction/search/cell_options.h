// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

#include "daemon/geometry/types.h"

namespace camway::correction {

/// Number of cells after which a search decides whether its ends are in narrow places.
inline constexpr std::size_t kCellsBeforeNarrow = 12'000;

/// Options of a cell search (`cell_search.h`). All lengths are in metres.
struct CellOptions {
  double ball_radius_m = 0.0;  ///< radius of the ball whose way is searched
  /// Side of the smallest cells. [Limit: value > 0]
  double smallest_m = 0.01;
  std::size_t max_cells = 200'000;  ///< limit of the cells of a search
  /// Gap of the ball above which a larger gap does not make a way better. [Limit: value > 0]
  double comfort_m = 0.1;
  /// An end is in a narrow place if, among the first `kCellsBeforeNarrow` cells, none that is
  /// reached from it has a middle where the gap of the ball is at least this. With 0, no place is
  /// narrow. [Limit: value >= 0]
  double narrow_m = 0.0;
  /// Limit of the cells of a search of which an end is in a narrow place. `max_cells` holds, too.
  std::size_t max_cells_if_narrow = 200'000;
  /// If not empty, the way of a body that does not turn is searched, in place of a ball: returns
  /// the gap of the body at a place of its centre, at most `up_to_m`.
  std::function<double(const geometry::Vec3& center_W, double up_to_m)> body_gap_m{};
  double body_radius_m = 0.0;  ///< radius of that body's ball; beside the scene is room for it
};

}  // namespace camway::correction
