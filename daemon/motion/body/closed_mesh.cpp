// SPDX-License-Identifier: MIT
#include "daemon/motion/body/closed_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>

namespace camway::motion {
namespace {

/// An edge of a triangle, from the lower to the higher vertex.
struct Edge {
  std::uint32_t low;
  std::uint32_t high;
  bool is_upwards;  ///< whether the triangle runs through it from `low` to `high`

  [[nodiscard]] bool is_same_as(const Edge& other) const {
    return low == other.low && high == other.high;
  }
};

std::vector<Edge> edges_of(const MeshShape& mesh) {
  const std::vector<std::uint32_t> welded = welded_vertices(mesh);
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> v = {welded[t[0]], welded[t[1]], welded[t[2]]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = v[k];
      const std::uint32_t to = v[(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return a.low < b.low || (a.low == b.low && a.high < b.high);
  });
  return edges;
}

std::string place_text(const geometry::Vec3& point) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", point.x(), point.y(), point.z());
}

/// The fault of an edge with these triangles, if there is one. Readers of files number vertices in
/// their own way, so the places are told, too.
std::optional<std::string> fault_of_edge(std::span<const Edge> same, const MeshShape& mesh) {
  if (same.size() == 2 && same[0].is_upwards != same[1].is_upwards) return std::nullopt;
  const std::string edge =
      fmt::format("the edge between vertices {} and {}, from {} to {},", same.front().low,
                  same.front().high, place_text(mesh.vertices_C[same.front().low]),
                  place_text(mesh.vertices_C[same.front().high]));
  if (same.size() == 2) {
    return fmt::format(
        "{} has two triangles that run through it in the same direction: one of "
        "them is turned over",
        edge);
  }
  return fmt::format(
      "{} has {}; a solid has two triangles at each edge", edge,
      same.size() == 1 ? std::string("one triangle") : fmt::format("{} triangles", same.size()));
}

}  // namespace

std::vector<std::uint32_t> welded_vertices(const MeshShape& mesh) {
  const std::vector<geometry::Vec3>& points = mesh.vertices_C;
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    if (points[a] == points[b]) return a < b;
    return geometry::precedes(points[a], points[b]);
  });
  std::vector<std::uint32_t> welded(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_new = i == 0 || points[order[i]] != points[order[i - 1]];
    welded[order[i]] = is_new ? order[i] : welded[order[i - 1]];
  }
  return welded;
}

std::optional<std::string> fault_of_surface(const MeshShape& mesh) {
  const std::vector<Edge> edges = edges_of(mesh);
  if (edges.empty()) return "the mesh has no triangle with three different vertices";
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].is_same_as(edges[begin])) ++end;
    if (std::optional<std::string> fault =
            fault_of_edge(std::span(edges).subspan(begin, end - begin), mesh)) {
      return fault;
    }
    begin = end;
  }
  return std::nullopt;
}

std::vector<std::uint32_t> connected_parts(const MeshShape& mesh) {
  std::vector<std::uint32_t> root = welded_vertices(mesh);
  const auto root_of = [&](std::uint32_t vertex) {
    while (root[vertex] != vertex) vertex = root[vertex] = root[root[vertex]];
    return vertex;
  };
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
    for (std::size_t k = 1; k < 3; ++k) root[root_of(t[k])] = root_of(t[0]);
  }
  std::vector<bool> is_seen(root.size(), false);
  std::vector<std::uint32_t> parts;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t part = root_of(mesh.triangles[i][0]);
    if (is_seen[part]) continue;
    is_seen[part] = true;
    parts.push_back(i);
  }
  return parts;
}

}  // namespace camway::motion
