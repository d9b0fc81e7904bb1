// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace camway::correction {

/// Number of cells after which a search tells whether its ends are in narrow places.
inline constexpr std::size_t kCellsBeforeNarrow = 12'000;

struct CellOptions {
  double ball_radius_m = 0.0;
  /// Side of the smallest cells. [Limit: value > 0]
  double smallest_m = 0.01;
  std::size_t max_cells = 200'000;
  /// Gap above which more room does not make a way better. [Limit: value > 0]
  double comfort_m = 0.1;
  /// An end is in a narrow place if no cell reached from it among the first `kCellsBeforeNarrow`
  /// has a middle with this gap of the ball. 0 takes no place for narrow. [Limit: value >= 0]
  double narrow_m = 0.0;
  /// Limit of cells where an end is in a narrow place, beside `max_cells`.
  std::size_t max_cells_if_narrow = 200'000;
};

}  // namespace camway::correction
