// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "daemon/scene/import/surfaces/knot_axis.h"
#include "daemon/scene/import/surfaces/parametric_error.h"

namespace camway::scene::surfaces {

/// Evaluates a surface. Keeps a reference to it. Requires a surface without a fault (`fault_of`).
/// Thread-safe.
class SurfacePoints {
 public:
  explicit SurfacePoints(const ParametricSurface& surface)
      : surface_(surface.surface),
        axes_{KnotAxis(surface_.u_knots, surface_.u_points, surface.periods[0]),
              KnotAxis(surface_.v_knots, surface_.v_points, surface.periods[1])} {}

  /// The knots of u (0) or of v (1).
  [[nodiscard]] const KnotAxis& axis(std::size_t k) const { return axes_[k]; }

  /// The point at (u, v). Beyond the knots the first and the last polynomials go on.
  [[nodiscard]] Point point(const Parameters& at) const;

 private:
  const NurbsSurface& surface_;
  std::array<KnotAxis, 2> axes_;
};

}  // namespace camway::scene::surfaces
