// SPDX-License-Identifier: MIT
#include "daemon/motion/timing/retimed_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "daemon/motion/spline/cubic_spline.h"

namespace camway::motion {
namespace {

using geometry::Vec3;
using geometry::Vec4;

/// Slopes of the spline through `points` whose slopes at the ends are those of the given Bézier
/// curves, slowed by the law.
template <class Point>
std::vector<Point> slopes_of(const std::vector<Point>& points, const CubicPath& path,
                             std::array<Point, 4> CubicPiece::*curve, const TimeLaw& law) {
  const CubicPiece& first = path.pieces.front();
  const CubicPiece& last = path.pieces.back();
  const Point begin = first_slope(first.*curve, first.t1_s - first.t0_s, law.rate(path.begin_s()));
  const Point end = last_slope(last.*curve, last.t1_s - last.t0_s, law.rate(path.end_s()));
  return spline_slopes<Point>(law.new_knots_s(), points, begin, end);
}

}  // namespace

CubicPath retimed(const CubicPath& path, const TimeLaw& law) {
  std::vector<Vec3> positions;
  std::vector<Vec4> images;
  for (const double knot_s : law.knots_s()) {
    const CubicPoint point = path.at(knot_s);
    positions.push_back(point.position);
    images.push_back(point.image);
  }
  const std::vector<Vec3> velocities = slopes_of(positions, path, &CubicPiece::position, law);
  const std::vector<Vec4> rates = slopes_of(images, path, &CubicPiece::image, law);
  return cubic_path(path.reference, law.new_knots_s(), positions, velocities, images, rates);
}

CubicPath with_new_times(const CubicPath& path, const TimeLaw& law) {
  CubicPath result = path;
  for (CubicPiece& piece : result.pieces) {
    piece.t0_s = law.new_time_s(piece.t0_s);
    piece.t1_s = law.new_time_s(piece.t1_s);
  }
  return result;
}

bool slows_uniformly(const CubicPath& path, const TimeLaw& law) {
  const double factor = law.slow_down();
  return std::ranges::all_of(path.pieces, [&](const CubicPiece& piece) {
    const double wanted_s = factor * (piece.t1_s - piece.t0_s);
    const double duration_s = law.new_time_s(piece.t1_s) - law.new_time_s(piece.t0_s);
    return std::abs(duration_s - wanted_s) <= kSameRate * wanted_s;
  });
}

}  // namespace camway::motion
