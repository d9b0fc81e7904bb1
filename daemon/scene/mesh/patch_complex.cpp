// SPDX-License-Identifier: MIT
#include "daemon/scene/mesh/patch_complex.h"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>

namespace camway::scene {
namespace {

using Corners = std::array<std::uint32_t, 3>;  // of a triangle, increasing numbers of points

std::uint64_t mixed(std::uint64_t x) {  // the finaliser of SplitMix64 (Steele, Lea & Flood 2014)
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

std::uint64_t hash(const geometry::Vec3& v) {
  std::uint64_t result = 0;
  for (const double x : v)
    result = mixed(result ^ std::bit_cast<std::uint64_t>(x + 0.0));  // -0 = 0
  return result;
}

/// For each vertex the first one with the same coordinates.
std::vector<std::uint32_t> equal_vertices(const std::vector<geometry::Vec3>& vertices) {
  const std::size_t slots = std::bit_ceil(2 * vertices.size() + 1);
  std::vector<std::uint32_t> table(slots, kNoIndex);
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    std::size_t slot = hash(vertices[i]) & (slots - 1);
    while (table[slot] != kNoIndex && vertices[table[slot]] != vertices[i]) {
      slot = (slot + 1) & (slots - 1);
    }
    if (table[slot] == kNoIndex) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

class Builder {
 public:
  explicit Builder(const Mesh& mesh)
      : vertices_(mesh.vertices.size()), alive_(mesh.triangles.size(), 1) {
    const std::vector<std::uint32_t> point_of = equal_vertices(mesh.vertices);
    corners_.reserve(mesh.triangles.size());
    for (const Corners& t : mesh.triangles) {
      Corners c = {point_of[t[0]], point_of[t[1]], point_of[t[2]]};
      std::sort(c.begin(), c.end());
      corners_.push_back(c);
    }
  }

  PatchComplex build() {
    drop_copies();
    find_edges();
    peel();
    join_patches();
    return {.patches = Lists(patch_of_, patches_), .seams = seams()};
  }

 private:
  void drop_copies() {
    std::vector<std::uint32_t> lowest(corners_.size());
    for (std::size_t t = 0; t < corners_.size(); ++t) {
      const Corners& c = corners_[t];
      if (c[0] == c[1] || c[1] == c[2]) alive_[t] = 0;
      lowest[t] = alive_[t] != 0 ? c[0] : kNoIndex;
    }
    Lists at(lowest, vertices_);
    const auto key = [&](std::uint32_t t) { return std::pair(corners_[t][1], corners_[t][2]); };
    for (std::size_t v = 0; v < vertices_; ++v) {
      const std::span<std::uint32_t> list = at[v];
      std::sort(list.begin(), list.end(), [&](std::uint32_t s, std::uint32_t t) {
        return std::pair(key(s), s) < std::pair(key(t), t);
      });
      for (std::size_t i = 1; i < list.size(); ++i) {
        if (key(list[i]) == key(list[i - 1])) alive_[list[i]] = 0;
      }
    }
  }

  /// Ends of side `3 t + k` of triangle t, increasing.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> ends(std::uint32_t side) const {
    const Corners& c = corners_[side / 3];
    const std::uint32_t k = side % 3;
    return {c[k == 2 ? 1 : 0], c[k == 0 ? 1 : 2]};
  }

  void find_edges() {
    std::vector<std::uint32_t> lower_end(3 * corners_.size(), kNoIndex);
    for (std::uint32_t side = 0; side < lower_end.size(); ++side) {
      if (alive_[side / 3] != 0) lower_end[side] = ends(side).first;
    }
    Lists at(lower_end, vertices_);
    edge_of_.assign(lower_end.size(), kNoIndex);
    std::uint32_t edges = 0;
    for (std::size_t v = 0; v < vertices_; ++v) {
      const std::span<std::uint32_t> list = at[v];
      std::sort(list.begin(), list.end(), [&](std::uint32_t s, std::uint32_t t) {
        return std::pair(ends(s).second, s) < std::pair(ends(t).second, t);
      });
      for (std::size_t i = 0; i < list.size(); ++i) {
        if (i == 0 || ends(list[i]).second != ends(list[i - 1]).second) ++edges;
        edge_of_[list[i]] = edges - 1;
      }
    }
    sides_of_ = Lists(edge_of_, edges);
    alive_at_.resize(edges);
    for (std::size_t e = 0; e < edges; ++e) {
      alive_at_[e] = static_cast<std::uint32_t>(sides_of_[e].size());
    }
  }

  /// Removes triangles that have an edge of their own until there are none.
  void peel() {
    std::vector<std::uint32_t> single;
    for (std::uint32_t e = 0; e < alive_at_.size(); ++e) {
      if (alive_at_[e] == 1) single.push_back(e);
    }
    while (!single.empty()) {
      const std::uint32_t edge = single.back();
      single.pop_back();
      for (const std::uint32_t side : sides_of_[edge]) {
        const std::uint32_t t = side / 3;
        if (alive_[t] == 0) continue;
        alive_[t] = 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
          if (--alive_at_[edge_of_[3 * t + k]] == 1) single.push_back(edge_of_[3 * t + k]);
        }
      }
    }
  }

  [[nodiscard]] std::vector<std::uint32_t> alive_triangles(std::size_t edge) const {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t side : sides_of_[edge]) {
      if (alive_[side / 3] != 0) result.push_back(side / 3);
    }
    return result;
  }

  void join_patches() {
    patch_of_.assign(corners_.size(), kNoIndex);
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t seed = 0; seed < corners_.size(); ++seed) {
      if (alive_[seed] == 0 || patch_of_[seed] != kNoIndex) continue;
      patch_of_[seed] = patches_;
      waiting.push_back(seed);
      while (!waiting.empty()) {
        const std::uint32_t t = waiting.back();
        waiting.pop_back();
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::uint32_t edge = edge_of_[3 * t + k];
          if (alive_at_[edge] != 2) continue;
          for (const std::uint32_t side : sides_of_[edge]) {
            if (alive_[side / 3] == 0 || patch_of_[side / 3] != kNoIndex) continue;
            patch_of_[side / 3] = patches_;
            waiting.push_back(side / 3);
          }
        }
      }
      ++patches_;
    }
  }

  [[nodiscard]] std::vector<std::vector<std::uint32_t>> seams() const {
    std::vector<std::vector<std::uint32_t>> result;
    for (std::size_t e = 0; e < alive_at_.size(); ++e) {
      if (alive_at_[e] <= 2) continue;
      std::vector<std::uint32_t> patches = alive_triangles(e);
      for (std::uint32_t& t : patches) t = patch_of_[t];
      std::sort(patches.begin(), patches.end());
      std::vector<std::uint32_t> odd;
      for (const std::uint32_t patch : patches) {
        if (!odd.empty() && odd.back() == patch) {
          odd.pop_back();
        } else {
          odd.push_back(patch);
        }
      }
      if (!odd.empty()) result.push_back(std::move(odd));
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  std::size_t vertices_;
  std::vector<Corners> corners_;
  std::vector<std::uint8_t> alive_;
  std::vector<std::uint32_t> edge_of_;   ///< by side
  Lists sides_of_;                       ///< by edge
  std::vector<std::uint32_t> alive_at_;  ///< by edge, how many of its triangles are alive
  std::vector<std::uint32_t> patch_of_;
  std::uint32_t patches_ = 0;
};

}  // namespace

PatchComplex make_patch_complex(const Mesh& mesh) { return Builder(mesh).build(); }

}  // namespace camway::scene
