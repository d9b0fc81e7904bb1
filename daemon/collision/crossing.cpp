// SPDX-License-Identifier: MIT
#include "daemon/collision/crossing.h"

#include <algorithm>
#include <cmath>

#include "daemon/geometry/rounding.h"

namespace camway::collision {

namespace {

using geometry::Triangle;
using geometry::Vec3;

// Rounding of c·(a×b)/|a×b| for differences a, b, c of coordinates no further apart than S in any
// axis, with u = 2^-53:
// 1. Differences round by u, the products and sums of a×b by 3u: |a||b| times 10u in length.
// 2. The product with c: |c|·(10u·|a||b| + 4u·|a×b|) <= 14u·|c||a||b|.
// 3. Division by a length with the relative error 10u·k + 4u, k = |a||b| / |a×b|, of a quotient
//    that is at most |c|: as much again.
// 28u·|c|·k with |c| <= √3·S: 49u·S·k; 64 covers the second order.
constexpr double kHeightRounding = 64.0 * geometry::kUnitRoundoff;

// Signed distance of a point from the plane through the directions a and b, or between lines with
// these directions, and a bound of its rounding.
struct Height {
  double value_m;
  double error_m;

  [[nodiscard]] double surely_m() const { return std::abs(value_m) - error_m; }
};

Height height_m(const Vec3& c, const Vec3& a, const Vec3& b, double scale_m) {
  const Vec3 normal = a.cross(b);
  const double length = normal.norm();
  // For parallel directions the error is infinite or not a number: nothing is proved.
  const double error_m = kHeightRounding * scale_m * (a.norm() * b.norm() / length);
  return {c.dot(normal) / length, error_m};
}

double scale_of(const Triangle& a, const Triangle& b) {
  double scale_m = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    scale_m = std::max({scale_m, (a[i] - a[0]).lpNorm<Eigen::Infinity>(),
                        (b[i] - a[0]).lpNorm<Eigen::Infinity>()});
  }
  return 2.0 * scale_m;  // between any two of the six points
}

// Margin with which the segment from p to q passes through `disc`. Its ends are at least as far
// from the disc as from the plane of the disc, and the segment is at least as far from a side as
// their lines are from each other. It passes through the inside if its ends lie on opposite sides
// of the plane and its line passes all three sides in the same sense.
double passing_margin_m(const Vec3& p, const Vec3& q, const Triangle& disc, double scale_m,
                        double enough_m) {
  const Vec3 e = disc[1] - disc[0];
  const Vec3 f = disc[2] - disc[0];
  const Vec3 normal = e.cross(f);
  // Most segments do not cross the plane: signs alone tell, without a square root.
  if (!(normal.dot(p - disc[0]) * normal.dot(q - disc[0]) < 0.0)) return 0.0;
  const Height from = height_m(p - disc[0], e, f, scale_m);
  const Height to = height_m(q - disc[0], e, f, scale_m);
  double margin_m = std::min(from.surely_m(), to.surely_m());
  double sense = 0.0;
  for (std::size_t i = 0; i < 3 && margin_m > enough_m; ++i) {
    const Height side = height_m(p - disc[i], q - p, disc[(i + 1) % 3] - disc[i], scale_m);
    if (side.value_m * sense < 0.0) return 0.0;
    sense = side.value_m;
    // In this order "not a number" yields no margin.
    margin_m = side.surely_m() < margin_m ? side.surely_m() : margin_m;
    if (!(side.surely_m() > enough_m)) return 0.0;
  }
  return margin_m > enough_m ? margin_m : 0.0;
}

}  // namespace

double crossing_margin_m(const Triangle& a, const Triangle& b, double enough_m) {
  const double scale_m = scale_of(a, b);
  double margin_m = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double better_m = std::max(enough_m, margin_m);
    margin_m = std::max({margin_m, passing_margin_m(a[i], a[j], b, scale_m, better_m),
                         passing_margin_m(b[i], b[j], a, scale_m, better_m)});
  }
  return margin_m;
}

}  // namespace camway::collision
