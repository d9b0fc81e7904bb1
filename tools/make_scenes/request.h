// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tools/make_scenes/solid.h"

namespace camway::make_scenes {

/// A unit quaternion w, x, y, z that rotates the camera frame (looks down -z, +y up) into the
/// world.
using Quaternion = std::array<double, 4>;
using Direction = std::array<double, 3>;

/// Returns the orientation that looks along `forward`, without roll. Requires a length above 0.
Quaternion look_along(const Direction& forward);

/// Returns `orientation`, rotated by 90 degrees about the viewing direction.
Quaternion rolled_90(const Quaternion& orientation);

struct View {
  Point eye{};
  Quaternion orientation{1, 0, 0, 0};
};

struct Lens {
  int fov_x_deg = 80;
  int fov_y_deg = 60;
  Um near = mm(200);
};

struct Request {
  std::string name;
  std::string purpose;  ///< text for scenes/README.md
  Lens lens;
  std::vector<View> views;
  std::vector<int> times_ms;  ///< one for each view, or empty
};

/// Returns views at `eyes` in the direction of travel: from the point before to the point after.
std::vector<View> along(const std::vector<Point>& eyes);

/// Returns views at `eyes` that all look along `forward`.
std::vector<View> facing(const std::vector<Point>& eyes, const Direction& forward);

/// Returns the text of the request file for the scene file `scene`.
std::string to_json(const Request& request, const std::string& scene);

/// Returns the distance between the filled near quadrilateral at `view` and the triangles, at most
/// `cutoff_m`. It serves a check only; no file depends on it.
double clearance_m(const std::vector<Triangle>& triangles, const Lens& lens, const View& view,
                   double cutoff_m);

}  // namespace camway::make_scenes
