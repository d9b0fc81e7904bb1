// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "daemon/scene/import/readers/polygon_cutter.h"

namespace camway::scene::surfaces {

using mesh_readers::Point;

/// How far facets may be from the smooth surface, as a part of its size: a sphere takes 6480
/// triangles then, and one of the size of a head is within 0.1 mm.
inline constexpr double kRelativeTolerance = 1e-3;

/// A smooth surface as triangles between points that lie on it.
struct FacetedSurface {
  std::vector<Point> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Bound of the distance of any point of the surface from the triangles, and of any point of the
  /// triangles from the surface.
  double error = 0.0;
};

}  // namespace camway::scene::surfaces
