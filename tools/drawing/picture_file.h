// SPDX-License-Identifier: MIT
#pragma once

#include <cairo.h>

#include <functional>
#include <string>

#include "tools/drawing/floor_plan.h"

namespace camway::draw {

/// Size of a picture. [Units: pixels]
struct PictureSize {
  double width_px;
  double height_px;
};

/// Writes the same drawing to each of `files` that has a name. `draw` is called once for each file,
/// with a white ground. A PNG file has two pixels for each of `size` in either direction. Returns
/// an error text that names the file, empty on success.
std::string write_pictures(const PictureFiles& files, const PictureSize& size,
                           const std::function<void(cairo_t*)>& draw);

/// Returns a drawing as the text of an SVG file; empty if it cannot be drawn.
std::string svg_picture(const PictureSize& size, const std::function<void(cairo_t*)>& draw);

}  // namespace camway::draw
