// SPDX-License-Identifier: MIT
#include "daemon/geometry/ray_crossing.h"

#include <array>

#include "daemon/geometry/exact_orientation.h"

namespace camway::geometry {
namespace {

/// Sign of the area of `a`, `b`, `origin` + (ε, ε²); 0 only where `a` and `b` are equal.
int moved_orientation(const Vec2& a, const Vec2& b, const Vec2& origin) {
  const int sign = orientation(a, b, origin);
  if (sign != 0) return sign;
  // The derivatives with respect to the first and the second coordinate of `origin`.
  if (a.y() != b.y()) return a.y() > b.y() ? 1 : -1;
  return (b.x() > a.x() ? 1 : 0) - (b.x() < a.x() ? 1 : 0);
}

/// Whether the shifted ray may meet the triangle, by exact comparison of boxes: false only if it
/// misses.
bool may_hit(const Vec3& origin, const Triangle& t) {
  const auto beside = [&](int k) {
    return (t[0][k] < origin[k] && t[1][k] < origin[k] && t[2][k] < origin[k]) ||
           (k != 0 && t[0][k] > origin[k] && t[1][k] > origin[k] && t[2][k] > origin[k]);
  };
  return !beside(1) && !beside(2) && !beside(0);
}

}  // namespace

RayHit ray_hit(const Vec3& origin, const Triangle& triangle) {
  if (!may_hit(origin, triangle)) return RayHit::kMiss;
  const Vec2 o = origin.tail<2>();
  const std::array<Vec2, 3> p = {triangle[0].tail<2>(), triangle[1].tail<2>(),
                                 triangle[2].tail<2>()};
  const int turn = moved_orientation(p[0], p[1], o);
  // The three signs add up to the projected area, so without area they are not all equal and
  // non-zero.
  if (turn == 0 || moved_orientation(p[1], p[2], o) != turn ||
      moved_orientation(p[2], p[0], o) != turn) {
    return RayHit::kMiss;
  }
  // `turn` is the sign of the normal's x; the plane lies ahead if `origin` is on its other side.
  const int side = orientation(triangle[0], triangle[1], triangle[2], origin);
  if (side == 0) return RayHit::kOnTriangle;
  if (side == turn) return RayHit::kMiss;
  return turn > 0 ? RayHit::kLeaves : RayHit::kEnters;
}

}  // namespace camway::geometry
