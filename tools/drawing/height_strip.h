// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "tools/drawing/floor_plan.h"
#include "tools/drawing/marks.h"

namespace camway::draw {

/// Draws the heights of the paths of a plan over time in a frame, with axes, floors, keyframes and
/// collisions.
void draw_height_strip(cairo_t* cr, const Frame& frame, const FloorPlan& plan,
                       const std::vector<double>& floors_m);

}  // namespace camway::draw
