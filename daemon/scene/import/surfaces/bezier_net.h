// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "daemon/scene/import/surfaces/nurbs_surface.h"

namespace camway::scene::surfaces {

/// The control points of a rational Bezier patch: (u degree + 1) * (v degree + 1), u fastest.
using Net = std::vector<WeightedPoint>;

/// (1 - part) a + part b.
inline WeightedPoint mixed(const WeightedPoint& a, const WeightedPoint& b, double part) {
  WeightedPoint result;
  for (std::size_t k = 0; k < 4; ++k) result[k] = (1.0 - part) * a[k] + part * b[k];
  return result;
}

/// The point in space. Requires a weight that is not 0.
inline Point projected(const WeightedPoint& p) { return {p[0] / p[3], p[1] / p[3], p[2] / p[3]}; }

/// The interval [low, high] of the polynomial between knots number `knot` and the next. It may
/// leave the span: the polynomial goes on.
struct SpanPart {
  std::size_t knot = 0;
  double low = 0.0;
  double high = 1.0;
};

/// The blossom of `count` times `high` and for the rest `low`, by de Boor's algorithm. If both are
/// the same it is the point of the curve there. Requires as `bezier_of_span`, and count <= degree.
WeightedPoint blossom(std::span<const WeightedPoint> points, const std::vector<double>& knots,
                      std::size_t degree, const SpanPart& part, std::size_t count);

/// Writes the degree + 1 control points of a part of a B-spline curve as a Bezier curve, by
/// blossoming: control point j is the blossom of j times `high`. Requires degree <= part.knot <
/// points.size(), and a span with a length.
void bezier_of_span(std::span<const WeightedPoint> points, const std::vector<double>& knots,
                    std::size_t degree, const SpanPart& part, std::span<WeightedPoint> result);

/// The control points of a part of a surface. Requires spans as for `bezier_of_span`.
Net bezier_net(const NurbsSurface& surface, const SpanPart& u, const SpanPart& v);

}  // namespace camway::scene::surfaces
