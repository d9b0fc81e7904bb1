// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tools/drawing/marks.h"

namespace camway::draw {

/// The values along a side of a frame: from the left or the bottom to the right or the top.
struct Axis {
  double begin;
  double end;  ///< may be below `begin`
  std::string name;
};

/// Room that the numbers of axes need at the left of a frame and below it. [Units: pixels]
inline constexpr double kAxisLeft_px = 48.0;
inline constexpr double kAxisBelow_px = 22.0;

/// Returns round values from the one end of an axis to the other, increasing: multiples of 1, 2 or
/// 5 times a power of ten, `most` at most. Requires most >= 2.
std::vector<double> ticks(const Axis& axis, std::size_t most);

/// Draws the border of a frame, and numbers and names at its left and its lower side. `has_grid`:
/// draws lines across the frame as well.
void draw_axes(cairo_t* cr, const Frame& frame, const Axis& across, const Axis& upward,
               bool has_grid);

}  // namespace camway::draw
