// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/array.h"
#include "daemon/base/result.h"
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

/// The arrays of a tree: what a file keeps of it. `IndexTree` documents them.
struct IndexArrays {
  base::Array<IndexNode> nodes;           ///< nodes, the root first
  base::Array<std::uint32_t> leaf_begin;  ///< leaf i holds references[leaf_begin[i] .. [i + 1])
  base::Array<std::uint32_t> references;  ///< numbers of items
  base::Array<ByteBoxes> boxes;           ///< boxes of references, by eight, in the parent's frame
  std::uint32_t depth = 0;

  bool operator==(const IndexArrays&) const = default;
};

/// Returns why no traversal may use these arrays for a tree over `items` items; empty if it may.
/// Each node and each leaf has one parent, whose number is lower; nothing refers to what is not
/// there; the depth is within the limits; the items of a leaf increase. Whether the boxes hold the
/// items is not checked.
std::string fault_in(const IndexArrays& arrays, std::size_t items);

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

  /// The tree of arrays from a file. Returns the fault that `fault_in` finds. `bounds` are the
  /// bounds of the items.
  static base::Result<IndexTree> of_arrays(IndexArrays arrays, std::size_t items,
                                           const geometry::Box& bounds);
  [[nodiscard]] const IndexArrays& arrays() const { return arrays_; }

  [[nodiscard]] const geometry::Box& bounds() const { return bounds_; }
  /// Number of inner nodes; octants without a triangle are not stored.
  [[nodiscard]] std::size_t nodes() const { return arrays_.nodes.size(); }
  [[nodiscard]] std::uint32_t leaves() const {
    return arrays_.leaf_begin.empty() ? 0
                                      : static_cast<std::uint32_t>(arrays_.leaf_begin.size() - 1);
  }
  [[nodiscard]] std::uint32_t depth() const { return arrays_.depth; }
  /// Number of entries in leaves, duplicates included.
  [[nodiscard]] std::size_t references() const { return arrays_.references.size(); }
  [[nodiscard]] std::uint64_t memory_bytes() const;

  /// The items of a leaf, in increasing order. [Limit: leaf < leaves()]
  [[nodiscard]] std::span<const std::uint32_t> leaf(std::uint32_t leaf) const {
    return std::span(arrays_.references)
        .subspan(arrays_.leaf_begin[leaf], arrays_.leaf_begin[leaf + 1] - arrays_.leaf_begin[leaf]);
  }

  /// Whether both trees have equal arrays, bit for bit, and so answer everything alike.
  [[nodiscard]] bool is_same_as(const IndexTree& other) const;

 private:
  friend class IndexWalk;
  friend class TreeWalk;

  /// The tree of a part with all entries, which `splitter` divides.
  static IndexTree assembled(const NodeSplitter& splitter, IndexPart all, unsigned threads);

  geometry::Box bounds_;
  IndexArrays arrays_;
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
