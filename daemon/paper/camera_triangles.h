// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/index/scene_index.h"

namespace camway::paper {

/// The second list of the paper's octree (Ptacek & Johnstone 2006, section 3): triangles of the
/// moving camera's surface, stored in the leaves that they intersect and separate from the scene's.
/// They never split a leaf: the tree is const and may be shared by any number of these lists.
///
/// A camera triangle is tested against scene triangles only within the leaves that contain both.
/// The tree must outlive the list. Thread-safe for const calls.
class CameraTriangles {
 public:
  explicit CameraTriangles(const scene::SceneIndex& index) : index_(&index) {}

  /// Inserts `triangle` under `id` into its leaves; replaces the triangle that had this id.
  void insert(std::uint32_t id, const geometry::Triangle& triangle);

  [[nodiscard]] std::size_t size() const { return triangles_.size(); }

  /// Returns the lowest index of a scene triangle that camera triangle `id` touches; nothing if
  /// there is none or the id is unknown. Equals `scene::SceneIndex::first_intersection`.
  [[nodiscard]] std::optional<std::uint32_t> first_hit(std::uint32_t id) const;

  /// Ids of the camera triangles in `leaf`, increasing.
  [[nodiscard]] std::vector<std::uint32_t> leaf_ids(std::uint32_t leaf) const;

  /// Leaves that contain camera triangle `id`, increasing; empty for an unknown id.
  [[nodiscard]] std::span<const std::uint32_t> leaves_of(std::uint32_t id) const;

  /// Calls `visit(id)` for every camera triangle, ids increasing, until it returns false.
  template <class Visit>
  void for_each_id(const Visit& visit) const {
    for (const auto& [id, placed] : triangles_) {
      if (!visit(id)) return;
    }
  }

 private:
  struct Placed {
    geometry::Triangle triangle;
    std::vector<std::uint32_t> leaves;
  };

  void remove(std::uint32_t id);

  const scene::SceneIndex* index_;
  std::map<std::uint32_t, Placed> triangles_;  ///< ordered, for iteration in order of id
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> ids_in_leaf_;  ///< never iterated
};

}  // namespace camway::paper
