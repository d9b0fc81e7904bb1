// SPDX-License-Identifier: MIT
#include "daemon/collision/crossing.h"

#include <algorithm>

#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"

namespace camway::collision {

namespace {

using geometry::Triangle;
using geometry::Vec3;

Triangle point(const Vec3& p) { return {p, p, p}; }
Triangle edge(const Vec3& p, const Vec3& q) { return {p, q, q}; }

double surely_apart_m(const Triangle& a, const Triangle& b) {
  return geometry::triangle_distance(a, b) - geometry::triangle_distance_error_m(a, b);
}

// Whether the ends lie on two sides of the plane of `disc`, each further away than that: an
// estimate, only to be quick about the many that do not.
bool seems_to_pass(const Vec3& p, const Vec3& q, const Triangle& disc, double enough_m) {
  const Vec3 normal = (disc[1] - disc[0]).cross(disc[2] - disc[0]);
  const double height_p = normal.dot(p - disc[0]);
  const double height_q = normal.dot(q - disc[0]);
  const double enough = enough_m * normal.norm();
  return height_p * height_q < 0.0 && std::min(std::abs(height_p), std::abs(height_q)) > enough;
}

// The margin with which the segment from p to q passes through `disc`.
double passing_margin_m(const Vec3& p, const Vec3& q, const Triangle& disc, double enough_m) {
  if (!seems_to_pass(p, q, disc, enough_m)) return 0.0;
  const Triangle segment = edge(p, q);
  double margin_m = std::min(surely_apart_m(point(p), disc), surely_apart_m(point(q), disc));
  for (std::size_t i = 0; i < 3 && margin_m > enough_m; ++i) {
    margin_m = std::min(margin_m, surely_apart_m(segment, edge(disc[i], disc[(i + 1) % 3])));
  }
  // Away from the border and with its ends elsewhere, it meets the disc once or not at all.
  if (!(margin_m > enough_m) || !geometry::triangles_touch(segment, disc)) return 0.0;
  return margin_m;
}

}  // namespace

double crossing_margin_m(const Triangle& a, const Triangle& b, double enough_m) {
  double margin_m = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    margin_m = std::max(margin_m, passing_margin_m(a[i], a[j], b, std::max(enough_m, margin_m)));
    margin_m = std::max(margin_m, passing_margin_m(b[i], b[j], a, std::max(enough_m, margin_m)));
  }
  return margin_m;
}

}  // namespace camway::collision
