// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tools/make_scenes/solid.h"

namespace camway::make_scenes {

/// Unit quaternion w, x, y, z from the camera frame (looks down -z, +y up) to the world.
using Quaternion = std::array<double, 4>;
using Direction = std::array<double, 3>;

/// Looks along `forward` (any length but 0) without roll.
Quaternion look_along(const Direction& forward);

/// `orientation`, turned by 90 degrees about the viewing direction.
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
  std::string purpose;  ///< for scenes/README.md
  Lens lens;
  std::vector<View> views;
  std::vector<int> times_ms;  ///< one for each view, or none
};

/// Views through `eyes`, each looking the way the camera travels there: from the point before it to
/// the point after it.
std::vector<View> along(const std::vector<Point>& eyes);

/// Views from `eyes` that all look along `forward`.
std::vector<View> facing(const std::vector<Point>& eyes, const Direction& forward);

/// The request file of `request` on the scene file `scene`.
std::string to_json(const Request& request, const std::string& scene);

/// Least distance in metres of the filled near quadrilateral at `view` to the triangles, or
/// `cutoff_m` if none is nearer. For checking only: nothing that is written depends on it.
double clearance_m(const std::vector<Triangle>& triangles, const Lens& lens, const View& view,
                   double cutoff_m);

}  // namespace camway::make_scenes
