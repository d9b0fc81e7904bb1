// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/index/index_node.h"
#include "daemon/scene/mesh/mesh.h"

namespace camway::scene {

/// How the triangles are dealt to the nodes of the tree. Queries give the same answers with all.
enum class Decomposition : std::uint8_t {
  kOctree,  ///< space into octants; a triangle goes to every octant that it lies in
  kKdTree,  ///< space by a plane, at the least surface area; a triangle goes to every side
  kBvh,     ///< triangles into two groups, at the least surface area; boxes may overlap
};

/// When a node splits, what bounds the tree whatever the input, and who builds it.
struct IndexOptions {
  Decomposition decomposition = Decomposition::kOctree;
  std::uint32_t threshold =
      16;  ///< a leaf with more triangles than this splits [Limit: value >= 1]
  std::uint32_t max_depth = 16;  ///< levels below the root [Limit: value <= kMaxIndexDepth]
  /// Largest number of triangle entries in leaves per triangle of the mesh; a node whose split
  /// would pass its share of that stays a leaf. [Limit: value >= 1]
  double max_duplication = 8.0;
  /// Threads that build; 0 for as many as the machine has. Never more than kMaxIndexThreads, and
  /// without any influence on the result.
  unsigned threads = 0;
};

inline constexpr std::uint32_t kMaxIndexDepth = 20;
inline constexpr unsigned kMaxIndexThreads = 8;

/// A spatial decomposition of things that have boxes (Ptacek & Johnstone 2006, section 3, for the
/// octree). One structure for all decompositions: a tree of wide nodes in flat arrays, with boxes
/// of a byte per side. Each node keeps the box that its contents really fill, so that empty space
/// is skipped at once. Bounded in depth and in duplication: what cannot be told apart by splitting
/// (a fan of triangles at one vertex) stays in one leaf. It is walked by `IndexWalk`. Immutable;
/// const calls are safe from any thread.
class IndexTree {
 public:
  /// Over nothing.
  IndexTree() = default;

  /// Over the triangles of `mesh`. The result depends on the mesh and the options only, not on the
  /// threads. Precondition: coordinates are below geometry::kLargestCoordinate_m.
  static IndexTree of_triangles(const Mesh& mesh, const IndexOptions& options);

  /// Over boxes, none of them empty, each in one leaf, mostly of its own.
  static IndexTree of_boxes(std::span<const geometry::Box> boxes);

  [[nodiscard]] const geometry::Box& bounds() const { return bounds_; }
  /// Inner nodes; octants without a triangle are not stored.
  [[nodiscard]] std::size_t nodes() const { return nodes_.size(); }
  [[nodiscard]] std::uint32_t leaves() const {
    return leaf_begin_.empty() ? 0 : static_cast<std::uint32_t>(leaf_begin_.size() - 1);
  }
  [[nodiscard]] std::uint32_t depth() const { return depth_; }
  /// Entries in leaves, duplicates included.
  [[nodiscard]] std::size_t references() const { return references_.size(); }
  [[nodiscard]] std::uint64_t memory_bytes() const;

  /// What a leaf holds, increasing. [Limit: leaf < leaves()]
  [[nodiscard]] std::span<const std::uint32_t> leaf(std::uint32_t leaf) const {
    return std::span(references_)
        .subspan(leaf_begin_[leaf], leaf_begin_[leaf + 1] - leaf_begin_[leaf]);
  }

  /// Whether the two have equal arrays, bit for bit: then they answer everything alike.
  [[nodiscard]] bool is_same_as(const IndexTree& other) const;

 private:
  friend class IndexAssembler;
  friend class IndexWalk;

  geometry::Box bounds_;
  std::vector<IndexNode> nodes_;           ///< the root first
  std::vector<std::uint32_t> leaf_begin_;  ///< leaf i holds references_[leaf_begin_[i] .. [i + 1])
  std::vector<std::uint32_t> references_;
  std::vector<ByteBoxes> boxes_;  ///< of references_, eight at a time, in the frame of the parent
  std::uint32_t depth_ = 0;
};

/// A mesh and the tree over its triangles.
struct IndexedMesh {
  /// Shares the mesh. Preconditions as those of `IndexTree::of_triangles`; not null.
  static std::shared_ptr<const IndexedMesh> build(std::shared_ptr<const Mesh> mesh,
                                                  const IndexOptions& options = {});

  std::shared_ptr<const Mesh> mesh;
  IndexTree tree;
};

}  // namespace camway::scene
