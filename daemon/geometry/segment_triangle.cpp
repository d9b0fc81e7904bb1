// SPDX-License-Identifier: MIT
#include "daemon/geometry/segment_triangle.h"

#include <algorithm>
#include <cmath>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"

namespace camway::geometry {
namespace {

/// Fraction along `segment` of its point closest to the segment `edge`.
double fraction_closest_to(const LineSegment& segment, const LineSegment& edge) {
  const Vec3 e = segment.to - segment.from;
  const Vec3 f = edge.to - edge.from;
  const Vec3 normal = e.cross(f);
  const double normal2 = normal.squaredNorm();
  if (normal2 > 0.0) {
    return clamp_to_unit((edge.from - segment.from).cross(f).dot(normal) / normal2);
  }
  const double length2 = e.squaredNorm();
  if (!(length2 > 0.0)) return 0.0;
  // Parallel: the end of the edge that comes first along the segment.
  return clamp_to_unit(std::min(e.dot(edge.from - segment.from), e.dot(edge.to - segment.from)) /
                       length2);
}

/// For a segment that touches the triangle without certainly crossing its plane: it starts on the
/// triangle, enters it over an edge, or ends on it.
double fraction_at_outline(const LineSegment& segment, const Triangle& triangle) {
  const double close_m =
      triangle_distance_error_m({segment.from, segment.to, segment.to}, triangle);
  const auto distance_at = [&](double fraction) {
    const Vec3 p = segment.from + fraction * (segment.to - segment.from);
    return triangle_distance({p, p, p}, triangle);
  };
  if (triangle_distance({segment.from, segment.from, segment.from}, triangle) <= close_m)
    return 0.0;
  double best = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double fraction = fraction_closest_to(segment, {triangle[i], triangle[(i + 1) % 3]});
    if (fraction < best && distance_at(fraction) <= close_m) best = fraction;
  }
  return best;
}

}  // namespace

std::optional<double> hit_fraction(const LineSegment& segment, const Triangle& triangle) {
  if (!triangles_touch({segment.from, segment.to, segment.to}, triangle)) return std::nullopt;
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double d0 = normal.dot(segment.from - triangle[0]);
  const double d1 = normal.dot(segment.to - triangle[0]);
  const double error_m =
      triangle_distance_error_m({segment.from, segment.to, segment.to}, triangle);
  // Both ends are off the plane by more than rounding: the crossing is well determined.
  const double clear = error_m * normal.lpNorm<1>();
  if ((d0 > clear && d1 < -clear) || (d0 < -clear && d1 > clear)) {
    return clamp_to_unit(d0 / (d0 - d1));
  }
  return fraction_at_outline(segment, triangle);
}

}  // namespace camway::geometry
