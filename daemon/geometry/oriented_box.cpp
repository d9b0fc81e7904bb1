// SPDX-License-Identifier: MIT
#include "daemon/geometry/oriented_box.h"

#include <algorithm>
#include <cmath>

#include "daemon/geometry/rounding.h"

namespace camway::geometry {
namespace {

/// Shorter than this, squares lose digits to underflow.
constexpr double kShortest_m = 0x1p-400;

/// Unit vector along `v` with its part along the unit vector `e` taken off. Twice, since the first
/// time leaves a rounding that is large beside a short rest (Kahan's "twice is enough").
Vec3 orthonormal(const Vec3& v, const Vec3& e) {
  const Vec3 once = (v - v.dot(e) * e).normalized();
  return (once - once.dot(e) * e).normalized();
}

/// The unit vector of the coordinate axis least along `e`.
Vec3 least_aligned(const Vec3& e) {
  Eigen::Index axis = 0;
  e.cwiseAbs().minCoeff(&axis);
  return Vec3::Unit(axis);
}

/// Columns orthonormal up to 8u each, for a derivation below.
Eigen::Matrix3d axes_of(const Triangle& triangle) {
  std::array<Vec3, 3> edges = {triangle[1] - triangle[0], triangle[2] - triangle[1],
                               triangle[0] - triangle[2]};
  std::sort(edges.begin(), edges.end(),
            [](const Vec3& a, const Vec3& b) { return a.squaredNorm() > b.squaredNorm(); });
  if (!(edges[0].norm() > kShortest_m)) return Eigen::Matrix3d::Identity();
  const Vec3 e = edges[0].normalized();
  // A sliver has no normal worth the name.
  constexpr double kSliver = 0x1p-20;
  const bool is_flat = edges[1].cross(e).norm() > kSliver * edges[1].norm();
  const Vec3 f = orthonormal(is_flat ? edges[1] : least_aligned(e), e);
  Eigen::Matrix3d axes;
  axes << e, f, e.cross(f);
  return axes;
}

}  // namespace

OrientedBox::OrientedBox(std::span<const Triangle> body)
    : origin_(body.front().front()), axes_(axes_of(body.front())) {
  for (const Triangle& triangle : body) {
    for (const Vec3& vertex : triangle) {
      const Vec3 along = axes_.transpose() * (vertex - origin_);
      low_ = low_.cwiseMin(along);
      high_ = high_.cwiseMax(along);
    }
  }
}

// Errors, with u = 2^-53, `scale` as in the contract and axes a_k orthonormal up to 8u:
//  1. a_k·(p - o) has the rounding of a difference, a product and two sums on at most
//     |a_k|_1·scale <= sqrt(3)·scale: 7u·scale. A gap has twice that and its own rounding,
//     15u·scale, and three gaps together 26u·scale.
//  2. The matrix of the axes stretches by at most 1 + 12u, so the gaps are too long by at most that
//     share of sqrt(3)·scale: 21u·scale.
// Together 47u·scale, far inside the 192u of `triangle_distance_error_m`.
double OrientedBox::axes_bound_m2(const Triangle& triangle) const {
  const Vec3 a = axes_.transpose() * (triangle[0] - origin_);
  const Vec3 b = axes_.transpose() * (triangle[1] - origin_);
  const Vec3 c = axes_.transpose() * (triangle[2] - origin_);
  const Vec3 above = a.cwiseMin(b).cwiseMin(c) - high_;
  const Vec3 below = low_ - a.cwiseMax(b).cwiseMax(c);
  return above.cwiseMax(below).cwiseMax(0.0).squaredNorm();
}

// Errors in units of u·scale, once the length of the normal n is divided out (|n|_1 <=
// sqrt(3)·|n|):
//  1. The middle of the box: coordinates along the axes 7 each (12 in length), that the axes are
//  not
//     quite orthonormal 24·sqrt(3) = 42 for the three, its own sums 6: 60.
//  2. n·(middle - t): 7. The radius: three products, each with 4·sqrt(3)·h <= 12 at a half extent
//     h <= sqrt(3)·scale: 36. The triangle's own extent along n, which is not 0 where n is rounded:
//     7 for each end, 14.
// Together 117, inside 192 again. That n is rounded does not matter: any direction is a proof.
double OrientedBox::plane_bound_m(const Triangle& triangle) const {
  const Vec3 e = triangle[1] - triangle[0];
  const Vec3 f = triangle[2] - triangle[0];
  const Vec3 normal = e.cross(f);
  const double length = normal.norm();
  if (!(length > kShortest_m)) return 0.0;
  const Vec3 along = axes_.transpose() * normal;
  const double middle = normal.dot(origin_ - triangle[0]) + along.dot(0.5 * (low_ + high_));
  const double radius = along.cwiseAbs().dot(0.5 * (high_ - low_));
  const double ne = normal.dot(e);
  const double nf = normal.dot(f);
  const double gap = std::max(middle - radius - std::max({0.0, ne, nf}),
                              std::min({0.0, ne, nf}) - middle - radius);
  return std::max(gap, 0.0) / length;
}

double OrientedBox::squared_distance_bound_m2(const Triangle& triangle) const {
  const double plane_m = plane_bound_m(triangle);
  return std::max(axes_bound_m2(triangle), plane_m * plane_m);
}

}  // namespace camway::geometry
