// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/bezier_net.h"

#include <algorithm>

namespace camway::scene::surfaces {

WeightedPoint blossom(std::span<const WeightedPoint> points, const std::vector<double>& knots,
                      std::size_t degree, const SpanPart& part, std::size_t count) {
  std::array<WeightedPoint, kMostDegree + 1> work;
  const std::size_t first = part.knot - degree;
  std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(first), degree + 1, work.begin());
  for (std::size_t r = 1; r <= degree; ++r) {
    const double argument = r <= count ? part.high : part.low;
    for (std::size_t i = degree; i >= r; --i) {
      const double low = knots[first + i];
      const double high = knots[part.knot + 1 + i - r];
      work[i] = mixed(work[i - 1], work[i], (argument - low) / (high - low));
    }
  }
  return work[degree];
}

void bezier_of_span(std::span<const WeightedPoint> points, const std::vector<double>& knots,
                    std::size_t degree, const SpanPart& part, std::span<WeightedPoint> result) {
  for (std::size_t j = 0; j <= degree; ++j) {
    result[j] = blossom(points, knots, degree, part, j);
  }
}

Net bezier_net(const NurbsSurface& surface, const SpanPart& u, const SpanPart& v) {
  const std::size_t p = surface.u_knots.size() - surface.u_points - 1;
  const std::size_t q = surface.v_knots.size() - surface.v_points - 1;
  Net rows((p + 1) * (q + 1));  // of the q + 1 rows that count
  for (std::size_t j = 0; j <= q; ++j) {
    const std::size_t row = (v.knot - q + j) * surface.u_points;
    bezier_of_span(std::span(surface.points).subspan(row, surface.u_points), surface.u_knots, p, u,
                   std::span(rows).subspan(j * (p + 1), p + 1));
  }
  Net net(rows.size());
  // The rows stand for the points from v.knot - q on, so a column is padded in front.
  Net column(v.knot + 1);
  std::array<WeightedPoint, kMostDegree + 1> bezier;
  for (std::size_t i = 0; i <= p; ++i) {
    for (std::size_t j = 0; j <= q; ++j) column[v.knot - q + j] = rows[j * (p + 1) + i];
    bezier_of_span(column, surface.v_knots, q, v, bezier);
    for (std::size_t j = 0; j <= q; ++j) net[j * (p + 1) + i] = bezier[j];
  }
  return net;
}

}  // namespace camway::scene::surfaces
