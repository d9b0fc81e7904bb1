// SPDX-License-Identifier: MIT
#include "daemon/geometry/oriented_box.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "daemon/base/cpu_dispatch.h"
#include "daemon/geometry/lanes.h"
#include "daemon/geometry/rounding.h"

namespace camway::geometry {
namespace {

/// Below this length squares lose digits to underflow.
constexpr double kShortest_m = 0x1p-400;

/// Range of squared lengths of normals that are used. Above: a gap along the normal is at most its
/// length times 2^202, and is squared. Below: that square underflows by at most 2^-1074, which is
/// 2^-674 m² in the result, while edges of such a normal are longer than 2^-102 m, so that the
/// square of the error allowed is above 2^-300 m².
constexpr double kLeastSquare = 0x1p-400;
constexpr double kGreatestSquare = 0x1p400;

/// Unit vector along `v` without its component along the unit vector `e`. The component is
/// subtracted twice, since the first subtraction leaves a rounding that is large beside a short
/// rest (Kahan's "twice is enough").
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

/// Rows are orthonormal up to 8u each; the derivation below uses this.
std::array<Vec3, 3> axes_of(const Triangle& triangle) {
  std::array<Vec3, 3> edges = {triangle[1] - triangle[0], triangle[2] - triangle[1],
                               triangle[0] - triangle[2]};
  if (edges[1].squaredNorm() > edges[0].squaredNorm()) std::swap(edges[0], edges[1]);
  if (edges[2].squaredNorm() > edges[0].squaredNorm()) std::swap(edges[0], edges[2]);
  if (!(edges[0].norm() > kShortest_m)) return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const Vec3 e = edges[0].normalized();
  // The normal of a sliver is mostly rounding.
  constexpr double kSliver = 0x1p-20;
  const Vec3 rest = edges[1] - edges[1].dot(e) * e;
  const bool is_flat = rest.squaredNorm() > kSliver * kSliver * edges[1].squaredNorm();
  const Vec3 f = orthonormal(is_flat ? edges[1] : least_aligned(e), e);
  return {e, f, e.cross(f)};
}

[[gnu::always_inline]] inline void load(const Eigen::Array4d& numbers, lanes::Numbers& out) {
  std::memcpy(&out, numbers.data(), sizeof out);
}

/// The axes of a box, loaded.
struct Axes {
  lanes::Numbers x, y, z;
};

[[gnu::always_inline]] inline void along(const Axes& axes, const Vec3& v, lanes::Numbers& out) {
  out = axes.x * v.x() + axes.y * v.y() + axes.z * v.z();
}

/// A box, loaded.
struct LoadedBox {
  Axes axes;
  lanes::Numbers low, high;
};

[[gnu::always_inline]] inline void load_box(const Eigen::Array4d& x, const Eigen::Array4d& y,
                                            const Eigen::Array4d& z, const Eigen::Array4d& low,
                                            const Eigen::Array4d& high, LoadedBox& out) {
  load(x, out.axes.x);
  load(y, out.axes.y);
  load(z, out.axes.z);
  load(low, out.low);
  load(high, out.high);
}

/// The extent of a triangle along axes, from an origin.
struct Extent {
  lanes::Numbers least, greatest;
};

[[gnu::always_inline]] inline void find_extent(const Axes& axes, const Vec3& origin,
                                               const Triangle& triangle, Extent& out) {
  lanes::Numbers a, b, c;
  along(axes, triangle[0] - origin, a);
  along(axes, triangle[1] - origin, b);
  along(axes, triangle[2] - origin, c);
  out.least = lanes::smaller(lanes::smaller(a, b), c);
  out.greatest = lanes::larger(lanes::larger(a, b), c);
}

/// Squared distance between an extent and that of a box.
[[gnu::always_inline]] inline double squared_gap(const Extent& extent, const lanes::Numbers& low,
                                                 const lanes::Numbers& high) {
  const lanes::Numbers above = extent.least - high;
  const lanes::Numbers below = low - extent.greatest;
  const lanes::Numbers gap = lanes::larger(lanes::larger(above, below), lanes::Numbers{});
  return gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2];
}

/// The plane of a triangle as boxes along some axes see it.
struct Plane {
  Vec3 normal;             ///< of any length
  double squared_length;   ///< of the normal
  double least, greatest;  ///< of the triangle along the normal, from its first vertex
  lanes::Numbers share;    ///< the normal along the axes

  /// Otherwise a square below could leave the range of doubles.
  [[nodiscard]] bool is_usable() const {
    return squared_length > kLeastSquare && squared_length < kGreatestSquare;
  }
};

[[gnu::always_inline]] inline void find_plane(const Axes& axes, const Triangle& triangle,
                                              Plane& out) {
  const Vec3 e = triangle[1] - triangle[0];
  const Vec3 f = triangle[2] - triangle[0];
  out.normal = e.cross(f);
  out.squared_length = out.normal.squaredNorm();
  along(axes, out.normal, out.share);
  const double ne = out.normal.dot(e);
  const double nf = out.normal.dot(f);
  out.least = std::min({0.0, ne, nf});
  out.greatest = std::max({0.0, ne, nf});
}

/// Squared distance between a plane and a box. `origin` is where the extents of the box begin,
/// along the normal from the first vertex of the triangle.
[[gnu::always_inline]] inline double squared_gap(const Plane& plane, double origin,
                                                 const lanes::Numbers& low,
                                                 const lanes::Numbers& high) {
  const lanes::Numbers size = lanes::magnitude(plane.share);
  const lanes::Numbers middles = plane.share * (0.5 * (low + high));
  const lanes::Numbers radii = size * (0.5 * (high - low));
  const double middle = origin + (middles[0] + middles[1] + middles[2]);
  const double radius = radii[0] + radii[1] + radii[2];
  const double gap = std::max(middle - radius - plane.greatest, plane.least - middle - radius);
  return gap > 0.0 ? gap * gap / plane.squared_length : 0.0;
}

}  // namespace

OrientedBox::OrientedBox(std::span<const Triangle> body) {
  const std::array<Vec3, 3> axes = axes_of(body.front());
  for (int k = 0; k < 3; ++k) {
    const Vec3& axis = axes[static_cast<std::size_t>(k)];
    x_[k] = axis.x();
    y_[k] = axis.y();
    z_[k] = axis.z();
  }
  fit(body);
}

OrientedBox OrientedBox::around(std::span<const Triangle> body) const {
  OrientedBox box = *this;
  box.fit(body);
  return box;
}

CAMWAY_FOR_EVERY_PROCESSOR
void OrientedBox::fit(std::span<const Triangle> body) {
  origin_ = body.front().front();
  Axes axes;
  load(x_, axes.x);
  load(y_, axes.y);
  load(z_, axes.z);
  lanes::Numbers low = {};
  lanes::Numbers high = {};
  for (const Triangle& triangle : body) {
    for (const Vec3& vertex : triangle) {
      lanes::Numbers at;
      along(axes, vertex - origin_, at);
      low = lanes::smaller(at, low);
      high = lanes::larger(at, high);
    }
  }
  std::memcpy(low_.data(), &low, sizeof low);
  std::memcpy(high_.data(), &high, sizeof high);
}

// Errors, with u = 2^-53, `scale` as in the contract and axes a_k orthonormal up to 8u:
// 1. a_k·(p - o) has the rounding of a difference, a product and two sums on at most |a_k|_1·scale
//    <= sqrt(3)·scale: 7u·scale. A gap has twice that and its own rounding, 15u·scale, and three
//    gaps together 26u·scale.
// 2. The matrix of the axes lengthens vectors by at most the factor 1 + 12u, so the gaps are too
//    long by at most that share of sqrt(3)·scale: 21u·scale.
// Together 47u·scale, far inside the 192u of `triangle_distance_error_m`.
CAMWAY_FOR_EVERY_PROCESSOR
double OrientedBox::axes_bound_m2(const Triangle& triangle) const {
  LoadedBox box;
  load_box(x_, y_, z_, low_, high_, box);
  Extent extent;
  find_extent(box.axes, origin_, triangle, extent);
  return squared_gap(extent, box.low, box.high);
}

// Errors in units of u·scale, once the length of the normal n is divided out (|n|_1 <=
// sqrt(3)·|n|):
// 1. The middle of the box: coordinates along the axes 7 each (12 in length), that the axes are not
//    quite orthonormal 24·sqrt(3) = 42 for the three, its own sums 6: 60.
// 2. n·(middle - t): 7. The radius: three products, each with 4·sqrt(3)·h <= 12 at a half extent h
//    <= sqrt(3)·scale: 36. The triangle's own extent along n, which is not 0 where n is rounded: 7
//    for each end, 14.
// Together 117, inside 192 again. The rounding of n does not matter: any direction is a proof.
CAMWAY_FOR_EVERY_PROCESSOR
double OrientedBox::plane_bound_m2(const Triangle& triangle) const {
  LoadedBox box;
  load_box(x_, y_, z_, low_, high_, box);
  Plane plane;
  find_plane(box.axes, triangle, plane);
  if (!plane.is_usable()) return 0.0;
  return squared_gap(plane, plane.normal.dot(origin_ - triangle[0]), box.low, box.high);
}

// The boxes have the axes in common and, where the parts begin at the same corner, the origin.
CAMWAY_FOR_EVERY_PROCESSOR
bool OrientedBox::bound_two(std::span<const OrientedBox, 2> parts, const Triangle& triangle,
                            double most_m2, TwoBounds& out) const {
  LoadedBox box;
  load_box(x_, y_, z_, low_, high_, box);
  Plane plane;
  find_plane(box.axes, triangle, plane);
  double origin = plane.normal.dot(origin_ - triangle[0]);
  if (plane.is_usable() && squared_gap(plane, origin, box.low, box.high) > most_m2) return false;
  const Vec3* from = &origin_;
  Extent extent;
  find_extent(box.axes, *from, triangle, extent);
  for (std::size_t i = 0; i < 2; ++i) {
    const OrientedBox& part = parts[i];
    load(part.low_, box.low);
    load(part.high_, box.high);
    if (part.origin_ != *from) {
      from = &part.origin_;
      origin = plane.normal.dot(*from - triangle[0]);
      find_extent(box.axes, *from, triangle, extent);
    }
    out.axes_m2[i] = squared_gap(extent, box.low, box.high);
    out.plane_m2[i] = plane.is_usable() ? squared_gap(plane, origin, box.low, box.high) : 0.0;
  }
  return true;
}

double OrientedBox::squared_distance_bound_m2(const Triangle& triangle) const {
  return std::max(axes_bound_m2(triangle), plane_bound_m2(triangle));
}

}  // namespace camway::geometry
