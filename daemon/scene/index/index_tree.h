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

class NodeSplitter;
struct IndexPart;

/// Options of the build: when a node splits, the limits of the tree for any input, and the threads.
struct IndexOptions {
  std::uint32_t threshold = 16;  ///< most triangles of a leaf that is not split [Limit: value >= 1]
  std::uint32_t max_depth = 16;  ///< most levels below the root [Limit: value <= kMaxIndexDepth]
  /// Most triangle entries in leaves per triangle of the mesh. A node whose split would exceed its
  /// share of these stays a leaf. [Limit: value >= 1]
  double max_duplication = 8.0;
  /// Number of threads that build; 0 for one per processor; at most kMaxIndexThreads are used. The
  /// result does not depend on it.
  unsigned threads = 0;
};

inline constexpr std::uint32_t kMaxIndexDepth = 20;
inline constexpr unsigned kMaxIndexThreads = 8;

/// A spatial decomposition of items that have boxes: an octree over triangles (Ptacek & Johnstone
/// 2006, section 3), or groups of boxes over meshes. One structure serves both, and any other tree
/// that a node splitter makes: wide nodes in flat arrays, with boxes of a byte per side. Each node
/// keeps the tight box of its contents, so that queries skip empty space. Depth and duplication are
/// bounded: items that no split separates (a fan of triangles at one vertex) stay in one leaf.
/// `IndexWalk` traverses the tree.
/// Immutable. Thread-safe.
class IndexTree {
 public:
  /// A tree without items.
  IndexTree() = default;

  /// The octree over the triangles of `mesh`. The result depends on the mesh and the options only,
  /// not on the number of threads. Requires coordinates below geometry::kLargestCoordinate_m.
  static IndexTree of_triangles(const Mesh& mesh, const IndexOptions& options);

  /// The tree that `splitter` makes of the triangles of `mesh`, to compare the octree with others.
  /// Requires a splitter for this mesh and these options; otherwise as above.
  static IndexTree of_triangles(const Mesh& mesh, const NodeSplitter& splitter,
                                const IndexOptions& options);

  /// The tree over `boxes`, each in one leaf, usually of its own. Requires that none is empty.
  static IndexTree of_boxes(std::span<const geometry::Box> boxes);

  [[nodiscard]] const geometry::Box& bounds() const { return bounds_; }
  /// Number of inner nodes; octants without a triangle are not stored.
  [[nodiscard]] std::size_t nodes() const { return nodes_.size(); }
  [[nodiscard]] std::uint32_t leaves() const {
    return leaf_begin_.empty() ? 0 : static_cast<std::uint32_t>(leaf_begin_.size() - 1);
  }
  [[nodiscard]] std::uint32_t depth() const { return depth_; }
  /// Number of entries in leaves, duplicates included.
  [[nodiscard]] std::size_t references() const { return references_.size(); }
  [[nodiscard]] std::uint64_t memory_bytes() const;

  /// The items of a leaf, in increasing order. [Limit: leaf < leaves()]
  [[nodiscard]] std::span<const std::uint32_t> leaf(std::uint32_t leaf) const {
    return std::span(references_)
        .subspan(leaf_begin_[leaf], leaf_begin_[leaf + 1] - leaf_begin_[leaf]);
  }

  /// Whether both trees have equal arrays, bit for bit, and so answer everything alike.
  [[nodiscard]] bool is_same_as(const IndexTree& other) const;

 private:
  friend class IndexAssembler;
  friend class IndexWalk;

  /// The tree of a part with all entries, which `splitter` divides.
  static IndexTree assembled(const NodeSplitter& splitter, IndexPart all, unsigned threads);

  geometry::Box bounds_;
  std::vector<IndexNode> nodes_;           ///< nodes, the root first
  std::vector<std::uint32_t> leaf_begin_;  ///< leaf i holds references_[leaf_begin_[i] .. [i + 1])
  std::vector<std::uint32_t> references_;
  std::vector<ByteBoxes> boxes_;  ///< boxes of references_, by eight, in the parent's frame
  std::uint32_t depth_ = 0;
};

/// A mesh and the tree over its triangles.
struct IndexedMesh {
  /// Builds the octree of `mesh`, which it shares. Requires a mesh that is not null; otherwise as
  /// `IndexTree::of_triangles`.
  static std::shared_ptr<const IndexedMesh> build(std::shared_ptr<const Mesh> mesh,
                                                  const IndexOptions& options = {});

  std::shared_ptr<const Mesh> mesh;
  IndexTree tree;
};

}  // namespace camway::scene
