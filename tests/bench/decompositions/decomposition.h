// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "daemon/scene/index/scene_index.h"
#include "tests/bench/decompositions/bsp_tree.h"

/// The spatial decompositions that are compared (Ptacek & Johnstone 2006, section 6).
namespace camway::bench {

/// A mesh in one of the decompositions. All answer as a loop over all triangles does.
/// Immutable. Thread-safe.
class Decomposition {
 public:
  Decomposition() = default;
  Decomposition(const Decomposition&) = delete;
  Decomposition& operator=(const Decomposition&) = delete;
  virtual ~Decomposition() = default;

  /// As `scene::SceneIndex::nearest`.
  [[nodiscard]] virtual std::optional<scene::Nearest> nearest(
      std::span<const geometry::Triangle> body, double cutoff_m) const = 0;
  /// As `scene::SceneIndex::any_within`.
  [[nodiscard]] virtual bool any_within(std::span<const geometry::Triangle> body,
                                        double distance_m) const = 0;
  /// Returns the numbers of nodes and triangles that `any_within` visits.
  [[nodiscard]] virtual QueryCost cost_within(std::span<const geometry::Triangle> body,
                                              double distance_m) const = 0;
  /// Whether the body touches any triangle.
  [[nodiscard]] virtual bool touches(std::span<const geometry::Triangle> body) const = 0;

  /// Memory without the mesh.
  [[nodiscard]] virtual std::uint64_t memory_bytes() const = 0;
  /// The scene's index, if it is made of this decomposition; else null.
  [[nodiscard]] virtual const scene::SceneIndex* index() const { return nullptr; }
};

/// The trees of a mesh that are no octrees, as `scene::IndexedMesh::build` makes the octree.
std::shared_ptr<const scene::IndexedMesh> build_kd_tree(std::shared_ptr<const scene::Mesh> mesh,
                                                        const scene::IndexOptions& options);
/// The hierarchy of bounding boxes is made as the tree over the meshes of a scene, of the boxes of
/// triangles instead of those of meshes.
std::shared_ptr<const scene::IndexedMesh> build_box_hierarchy(
    std::shared_ptr<const scene::Mesh> mesh, const scene::IndexOptions& options);

struct DecompositionKind {
  const char* name;
  std::unique_ptr<const Decomposition> (*build)(std::shared_ptr<const scene::Mesh> mesh,
                                                unsigned threads);
};

/// Octree, k-d tree, hierarchy of bounding boxes and BSP tree, in this order.
std::span<const DecompositionKind> decomposition_kinds();

}  // namespace camway::bench
