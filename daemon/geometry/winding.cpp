// SPDX-License-Identifier: MIT
#include "daemon/geometry/winding.h"

#include <array>
#include <cmath>

#include "daemon/geometry/ray_crossing.h"

namespace camway::geometry {
namespace {

/// False only if the ray from `point` along +x misses the box of the node, which holds its
/// triangles. Rounding is monotone: if |d| <= half exactly, the rounded |d| is <= half, too.
bool may_meet(const Vec3& point, const TriangleTree::Node& node) {
  const Vec3 offset = point - node.center;
  return std::abs(offset.y()) <= node.half.y() && std::abs(offset.z()) <= node.half.z() &&
         offset.x() <= node.half.x();
}

}  // namespace

std::optional<int> winding_number(const Vec3& point, std::span<const Triangle> triangles,
                                  const TriangleTree& tree) {
  int winding = 0;
  std::array<std::uint32_t, TriangleTree::kMaxDepth + 1> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t number = waiting[--count];
    const TriangleTree::Node& node = tree.nodes()[number];
    if (!may_meet(point, node)) continue;
    if (!node.is_leaf()) {
      waiting[count++] = node.second_child;
      waiting[count++] = number + 1;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const RayHit hit = ray_hit(point, triangles[tree.order()[i]]);
      if (hit == RayHit::kOnTriangle) return std::nullopt;
      winding += (hit == RayHit::kLeaves ? 1 : 0) - (hit == RayHit::kEnters ? 1 : 0);
    }
  }
  return winding;
}

}  // namespace camway::geometry
