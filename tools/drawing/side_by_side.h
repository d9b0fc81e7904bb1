// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "tools/drawing/floor_plan.h"

namespace camway::draw {

/// Draws two small floor plans beside each other, for a page of text: the path as interpolated with
/// its collisions, and the corrected path; a row of two for each storey that the path visits. The
/// picture has no details, no inserted keyframes and a legend of one line; the texts of `plan` do
/// not count. Returns an error text that names the file, empty on success.
std::string draw_side_by_side(const FloorPlan& plan, const PictureFiles& files);

}  // namespace camway::draw
