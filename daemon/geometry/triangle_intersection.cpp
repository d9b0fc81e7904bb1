// SPDX-License-Identifier: MIT
#include "daemon/geometry/triangle_intersection.h"

#include <algorithm>
#include <cmath>

#include "daemon/base/cpu_dispatch.h"
#include "daemon/geometry/exact_triangles.h"
#include "daemon/geometry/lanes.h"
#include "daemon/geometry/rounding.h"

namespace camway::geometry {
namespace {

/// Both triangles relative to a vertex of the first. A difference of two doubles is rounded once,
/// relative to the difference, so nothing is lost far from the origin.
struct LocalPair {
  Triangle a;
  Triangle b;
  double scale;  ///< no coordinate is larger
};

LocalPair to_local(const Triangle& a, const Triangle& b) {
  LocalPair local;
  const Vec3 origin = a[0];
  double scale = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    local.a[i] = a[i] - origin;
    local.b[i] = b[i] - origin;
    scale = std::max(
        {scale, local.a[i].lpNorm<Eigen::Infinity>(), local.b[i].lpNorm<Eigen::Infinity>()});
  }
  local.scale = scale;
  return local;
}

/// Whether one of three axes separates the triangles, beyond the error of the computed gap between
/// their projections.
///
/// With |v| <= scale per coordinate: v itself carries u·scale from the translation, a product u,
/// the two sums of a dot product 2u, each relative to at most |axis|_1·scale. That is 4u for each
/// of the two projections, and 2u for their difference (which is at most 2·|axis|_1·scale): 10u to
/// first order. 16 leaves room for the terms of second order and the rounding of the bound itself.
/// The rounding of the axis does not matter: any axis that separates is a proof.
[[gnu::always_inline]] inline bool any_separates(const LocalPair& p, const lanes::Vectors& axes) {
  using lanes::larger, lanes::magnitude, lanes::Numbers, lanes::smaller;
  const Numbers a0 = dot(axes, lanes::repeat(p.a[0]));
  const Numbers a1 = dot(axes, lanes::repeat(p.a[1]));
  const Numbers a2 = dot(axes, lanes::repeat(p.a[2]));
  const Numbers b0 = dot(axes, lanes::repeat(p.b[0]));
  const Numbers b1 = dot(axes, lanes::repeat(p.b[1]));
  const Numbers b2 = dot(axes, lanes::repeat(p.b[2]));
  const Numbers gap = larger(smaller(smaller(b0, b1), b2) - larger(larger(a0, a1), a2),
                             smaller(smaller(a0, a1), a2) - larger(larger(b0, b1), b2));
  const Numbers size = magnitude(axes.x) + magnitude(axes.y) + magnitude(axes.z);
  // False for NaN, so an overflow is no proof.
  const auto is_apart = gap > 16.0 * kUnitRoundoff * size * p.scale + kSmallestNormal;
  return (is_apart[0] | is_apart[1] | is_apart[2]) != 0;
}

[[gnu::always_inline]] inline bool surely_apart(const LocalPair& p) {
  const lanes::Vectors a = lanes::load(p.a);
  const lanes::Vectors b = lanes::load(p.b);
  const lanes::Vectors ea = lanes::rotated(a) - a;
  const lanes::Vectors eb = lanes::rotated(b) - b;
  const Vec3 normal_a = (p.a[1] - p.a[0]).cross(p.a[2] - p.a[1]);
  const Vec3 normal_b = (p.b[1] - p.b[0]).cross(p.b[2] - p.b[1]);
  if (any_separates(p, lanes::load(normal_b, normal_a, normal_a))) return true;
  for (std::size_t i = 0; i < lanes::kLanes; ++i) {
    if (any_separates(p, cross(lanes::repeat(ea, i), eb))) return true;
  }
  // Coplanar pairs are separated only by an edge's normal within the plane.
  return any_separates(p, cross(lanes::repeat(normal_a), ea)) ||
         any_separates(p, cross(lanes::repeat(normal_b), eb));
}

/// Sign of six times the signed volume of a tetrahedron, 0 if rounding may have produced it.
///
/// Each of the three difference vectors has a rounding of 2u·scale per coordinate on a length of at
/// most 2·scale (its end points carry u·scale each, and it is rounded itself: 4u·scale together).
/// The determinant has 6 products of 3 such coordinates, each at most 8·scale³ with a relative
/// error of 3·2u + 2u and 5u for the sums: 6·8·13u = 624u to first order.
int volume_sign(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s, double scale) {
  const double volume = (q - p).cross(r - p).dot(s - p);
  const double error = 1024.0 * kUnitRoundoff * scale * scale * scale + kSmallestNormal;
  if (volume > error) return 1;
  return volume < -error ? -1 : 0;
}

/// Whether an edge of `edges_of` certainly passes through the interior of `face`.
bool edge_surely_pierces(const Triangle& edges_of, const Triangle& face, double scale) {
  std::array<int, 3> side{};
  for (std::size_t i = 0; i < 3; ++i) {
    side[i] = volume_sign(face[0], face[1], face[2], edges_of[i], scale);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (side[i] * side[j] != -1) continue;
    const int s0 = volume_sign(edges_of[i], edges_of[j], face[0], face[1], scale);
    if (s0 == 0) continue;
    if (s0 == volume_sign(edges_of[i], edges_of[j], face[1], face[2], scale) &&
        s0 == volume_sign(edges_of[i], edges_of[j], face[2], face[0], scale)) {
      return true;
    }
  }
  return false;
}

bool boxes_apart(const Triangle& a, const Triangle& b) {
  for (int k = 0; k < 3; ++k) {
    if (std::max({a[0][k], a[1][k], a[2][k]}) < std::min({b[0][k], b[1][k], b[2][k]}) ||
        std::max({b[0][k], b[1][k], b[2][k]}) < std::min({a[0][k], a[1][k], a[2][k]})) {
      return true;
    }
  }
  return false;
}

bool share_a_vertex(const Triangle& a, const Triangle& b) {
  for (const Vec3& v : a) {
    if (v == b[0] || v == b[1] || v == b[2]) return true;
  }
  return false;
}

}  // namespace

CAMWAY_FOR_EVERY_PROCESSOR
bool triangles_touch(const Triangle& a, const Triangle& b) {
  if (boxes_apart(a, b)) return false;
  const LocalPair local = to_local(a, b);
  // Beyond this, products of four coordinates could overflow, and bounds with them.
  if (!(local.scale < 0x1p250)) return triangles_touch_exactly(a, b);
  if (surely_apart(local)) return false;
  if (edge_surely_pierces(local.a, local.b, local.scale) ||
      edge_surely_pierces(local.b, local.a, local.scale) || share_a_vertex(a, b)) {
    return true;
  }
  return triangles_touch_exactly(a, b);
}

}  // namespace camway::geometry
