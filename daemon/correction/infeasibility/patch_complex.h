// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "daemon/scene/mesh/mesh.h"

namespace camway::correction {

inline constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

/// Lists of numbers, one after the other in one array.
class Lists {
 public:
  Lists() = default;

  /// Deals the items 0 .. keys.size() - 1 to `lists` lists, each item to the one that its key names
  /// or, with kNoIndex, to none. Increasing in each list.
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

/// The triangles of a mesh that can belong to a closed surface, in pieces that belong to it as a
/// whole or not at all. A surface is closed if each edge has an even number of its triangles: a
/// cycle modulo 2. Edges are told by the exact coordinates of their ends, so a file that repeats
/// its vertices is no obstacle, and one in which they differ by a rounding has a slit.
///
/// Left out are, since no closed surface needs them: triangles with two equal corners; every copy
/// of a triangle but the first (two copies cancel); and, again and again, triangles with an edge
/// that no other has.
struct PatchComplex {
  /// Triangles that are joined, directly or through others, over edges that two of them have.
  Lists patches;
  /// Where patches meet: at an edge with more than two triangles, the patches with an odd number of
  /// them, increasing. Each set once. A union of patches is closed exactly if it has an even number
  /// of each set.
  std::vector<std::vector<std::uint32_t>> seams;
};

/// O(n log n). [Limit: fewer than 2^32 / 3 triangles]
PatchComplex make_patch_complex(const scene::Mesh& mesh);

}  // namespace camway::correction
