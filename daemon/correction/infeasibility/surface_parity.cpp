// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/surface_parity.h"

#include <algorithm>

#include "daemon/geometry/ray_crossing.h"

namespace camway::correction {
namespace {

using geometry::precedes;
using geometry::RayHit;
using geometry::Triangle;
using geometry::Vec3;

}  // namespace

std::optional<bool> is_odd(const Vec3& origin, const scene::Mesh& mesh,
                           std::span<const std::uint32_t> triangles) {
  bool odd = false;
  for (const std::uint32_t t : triangles) {
    const RayHit hit = geometry::ray_hit(origin, mesh.triangle(t));
    if (hit == RayHit::kOnTriangle) return std::nullopt;
    if (geometry::passes_through(hit)) odd = !odd;
  }
  return odd;
}

bool is_closed(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles) {
  using MeshEdge = std::pair<Vec3, Vec3>;
  std::vector<MeshEdge> edges;
  edges.reserve(3 * triangles.size());
  for (const std::uint32_t index : triangles) {
    const Triangle t = mesh.triangle(index);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = t[k];
      const Vec3& b = t[(k + 1) % 3];
      // An edge of length zero is no edge: the triangle is its one or two others, which cancel.
      if (a != b) edges.emplace_back(precedes(a, b) ? MeshEdge(a, b) : MeshEdge(b, a));
    }
  }
  std::sort(edges.begin(), edges.end(), [](const MeshEdge& a, const MeshEdge& b) {
    return a.first != b.first ? precedes(a.first, b.first) : precedes(a.second, b.second);
  });
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return false;
  }
  return true;
}

}  // namespace camway::correction
