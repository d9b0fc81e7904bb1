// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/surface_points.h"

#include <span>
#include <vector>

#include "daemon/scene/import/surfaces/bezier_net.h"

namespace camway::scene::surfaces {

Point SurfacePoints::point(const Parameters& at) const {
  const SpanPart u = axes_[0].part(at[0], at[0]);
  const SpanPart v = axes_[1].part(at[1], at[1]);
  const std::size_t q = axes_[1].degree();
  std::vector<WeightedPoint> column(v.knot + 1);
  for (std::size_t j = v.knot - q; j <= v.knot; ++j) {
    column[j] =
        blossom(std::span(surface_.points).subspan(j * surface_.u_points, surface_.u_points),
                surface_.u_knots, axes_[0].degree(), u, 0);
  }
  return projected(blossom(column, surface_.v_knots, q, v, 0));
}

}  // namespace camway::scene::surfaces
