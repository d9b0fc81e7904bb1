// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

inline constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

/// Lists of numbers, stored one after the other in one array.
class Lists {
 public:
  Lists() = default;

  /// Distributes the items 0 .. keys.size() - 1 to `lists` lists: each item goes to the list that
  /// its key names, or to none if that is kNoIndex. Each list is increasing.
  Lists(std::span<const std::uint32_t> keys, std::size_t lists) : begin_(lists + 1, 0) {
    for (const std::uint32_t key : keys) {
      if (key != kNoIndex) ++begin_[key + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    items_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t item = 0; item < keys.size(); ++item) {
      if (keys[item] != kNoIndex) items_[next[keys[item]]++] = item;
    }
  }

  [[nodiscard]] std::size_t size() const { return begin_.empty() ? 0 : begin_.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t list) const {
    return std::span(items_).subspan(begin_[list], begin_[list + 1] - begin_[list]);
  }
  [[nodiscard]] std::span<std::uint32_t> operator[](std::size_t list) {
    return std::span(items_).subspan(begin_[list], begin_[list + 1] - begin_[list]);
  }

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint32_t> items_;
};

/// The triangles of a mesh that can belong to a closed surface, grouped into patches. Every closed
/// surface contains either all triangles of a patch or none. A surface is closed if each edge
/// belongs to an even number of its triangles: a cycle modulo 2. Edges are identified by the exact
/// coordinates of their ends, so a file may repeat its vertices, but vertices that differ by a
/// rounding make a slit.
///
/// Leaves out triangles that no closed surface needs: triangles with two equal corners; all copies
/// of a triangle but the first (two copies cancel); and, repeatedly, triangles with an edge that no
/// other triangle has.
struct PatchComplex {
  /// Sets of triangles that are connected over edges with exactly two triangles.
  Lists patches;
  /// A seam is a set of patches. It stands for the edges that belong to more than two triangles: it
  /// contains each patch that has an odd number of triangles at the edge. Equal sets are stored
  /// once; the patches of a set increase. A union of patches is closed if and only if it contains
  /// an even number of the patches of every seam.
  std::vector<std::vector<std::uint32_t>> seams;
};

/// O(n log n). [Limit: fewer than 2^32 / 3 triangles]
PatchComplex make_patch_complex(const Mesh& mesh);

}  // namespace camway::scene
