// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/surface_parity.h"

#include <algorithm>
#include <array>

#include "daemon/geometry/exact_orientation.h"

namespace camway::correction {
namespace {

using geometry::precedes;
using geometry::Triangle;
using geometry::Vec2;
using geometry::Vec3;

/// Sign of the area of `a`, `b`, `origin` + (ε, ε²); 0 only where `a` and `b` are equal.
int moved_orientation(const Vec2& a, const Vec2& b, const Vec2& origin) {
  const int sign = geometry::orientation(a, b, origin);
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
  const int side = geometry::orientation(triangle[0], triangle[1], triangle[2], origin);
  if (side == 0) return RayHit::kOnTriangle;
  return side != turn ? RayHit::kHit : RayHit::kMiss;
}

std::optional<bool> is_odd(const Vec3& origin, const scene::Mesh& mesh,
                           std::span<const std::uint32_t> triangles) {
  bool odd = false;
  for (const std::uint32_t t : triangles) {
    const RayHit hit = ray_hit(origin, mesh.triangle(t));
    if (hit == RayHit::kOnTriangle) return std::nullopt;
    if (hit == RayHit::kHit) odd = !odd;
  }
  return odd;
}

bool is_closed(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles) {
  using Edge = std::pair<Vec3, Vec3>;
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const std::uint32_t index : triangles) {
    const Triangle t = mesh.triangle(index);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = t[k];
      const Vec3& b = t[(k + 1) % 3];
      // An edge of length zero is no edge: the triangle is its one or two others, which cancel.
      if (a != b) edges.emplace_back(precedes(a, b) ? Edge(a, b) : Edge(b, a));
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.first != b.first ? precedes(a.first, b.first) : precedes(a.second, b.second);
  });
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return false;
  }
  return true;
}

}  // namespace camway::correction
