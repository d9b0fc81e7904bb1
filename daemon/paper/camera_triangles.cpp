// SPDX-License-Identifier: MIT
#include "daemon/paper/camera_triangles.h"

#include <algorithm>
#include <limits>

#include "daemon/geometry/triangle_intersection.h"

namespace camway::paper {

void CameraTriangles::remove(std::uint32_t id) {
  const auto found = triangles_.find(id);
  if (found == triangles_.end()) return;
  for (const std::uint32_t leaf : found->second.leaves) std::erase(ids_in_leaf_[leaf], id);
  triangles_.erase(found);
}

void CameraTriangles::insert(std::uint32_t id, const geometry::Triangle& triangle) {
  remove(id);
  Placed& placed = triangles_[id];
  placed.triangle = triangle;
  index_->leaves_touching(triangle, placed.leaves);
  for (const std::uint32_t leaf : placed.leaves) ids_in_leaf_[leaf].push_back(id);
}

std::optional<std::uint32_t> CameraTriangles::first_hit(std::uint32_t id) const {
  const auto found = triangles_.find(id);
  if (found == triangles_.end()) return std::nullopt;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t lowest = kNone;
  for (const std::uint32_t leaf : found->second.leaves) {
    const scene::LeafTriangles in_leaf = index_->leaf_triangles(leaf);
    for (const std::uint32_t number : in_leaf.numbers) {
      const std::uint32_t index = in_leaf.first + number;
      if (index >= lowest) break;
      if (geometry::triangles_touch(found->second.triangle, index_->triangle(index))) {
        lowest = index;
      }
    }
  }
  if (lowest == kNone) return std::nullopt;
  return lowest;
}

std::vector<std::uint32_t> CameraTriangles::leaf_ids(std::uint32_t leaf) const {
  const auto found = ids_in_leaf_.find(leaf);
  if (found == ids_in_leaf_.end()) return {};
  std::vector<std::uint32_t> ids = found->second;
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::span<const std::uint32_t> CameraTriangles::leaves_of(std::uint32_t id) const {
  const auto found = triangles_.find(id);
  if (found == triangles_.end()) return {};
  return found->second.leaves;
}

}  // namespace camway::paper
