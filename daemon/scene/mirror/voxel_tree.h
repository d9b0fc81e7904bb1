// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

#include "daemon/scene/voxels/voxel_grid.h"
#include "daemon/scene/voxels/voxel_set.h"

namespace camway::scene {

/// A set of voxels as the octree that OctoMap makes of it: with the same cubes, eight full octants
/// always being joined to one. Nodes have eight bytes and lie beside their siblings, so searches
/// wait little for memory. Space outside its cubes is unoccupied. Trees before and after a change
/// of the set share the branches in which nothing changed. Immutable. Thread-safe.
class VoxelTree {
 public:
  /// A cube, larger than a voxel, that is neither empty nor full. Octants as in `VoxelCube::child`.
  struct Node {
    std::uint32_t first = 0;  ///< first octant that is a node; the others follow it
    std::uint8_t nodes = 0;   ///< bits of the octants that are nodes
    std::uint8_t full = 0;    ///< bits of the octants that are full
  };

  /// A node, and the array that holds its octants.
  struct Place {
    const Node* node;
    const Node* nodes;
  };

  /// Requires voxels of a `VoxelGrid`. If a stop is requested meanwhile the tree lacks voxels and
  /// must not be used.
  explicit VoxelTree(const VoxelSet& voxels, const std::stop_token& stop = {});

  /// The tree of `after`. Requires that this is the tree of `before`. A stop has the same effect.
  [[nodiscard]] VoxelTree updated(const VoxelSet& before, const VoxelSet& after,
                                  const std::stop_token& stop = {}) const;

  /// A cube that holds all voxels and is never full itself.
  [[nodiscard]] const VoxelCube& root_cube() const { return root_cube_; }
  [[nodiscard]] Place root() const { return {&root_, top_.data()}; }
  /// Requires that octant `index` of that node is a node.
  [[nodiscard]] Place child(const Place& place, unsigned index) const {
    const unsigned before = place.node->nodes & ((1U << index) - 1U);
    const Node* const node =
        place.nodes + place.node->first + static_cast<unsigned>(std::popcount(before));
    if ((node->nodes | node->full) != 0) return {node, place.nodes};
    const Branch& branch = *branches_[node->first];
    return {&branch.root, branch.nodes.data()};
  }

  [[nodiscard]] bool contains(const Voxel& voxel) const;

  /// Calls `visit` for every full cube, in the order of octants.
  template <class Visit>
  void for_each_cube(const Visit& visit) const {
    descend(root(), root_cube_, visit);
  }

  [[nodiscard]] std::uint64_t voxels() const { return voxels_; }
  /// The range of its voxels; VoxelSet::kNoVoxels if it has none.
  [[nodiscard]] const VoxelSet::Range& bounds() const { return bounds_; }
  /// Number of nodes and full cubes.
  [[nodiscard]] std::uint64_t node_count() const { return nodes_; }
  /// Memory of the tree, shared branches included.
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  friend class BranchBuilder;
  friend class VoxelTreeTop;

  /// A branch has 2^kBranchLevels blocks along an edge.
  static constexpr unsigned kBranchLevels = 3;

  /// The content of a cube of 64 x 64 x 64 voxels, which is not empty.
  struct Branch {
    std::uint64_t key = 0;    ///< key of its first block (`BlockKey`)
    std::uint64_t order = 0;  ///< Morton code of its position: the order of octants
    Node root;                ///< a full cube has all octants full
    std::vector<Node> nodes;
    std::uint64_t full_cubes = 0;
    std::uint64_t voxels = 0;
    VoxelSet::Range bounds = VoxelSet::kNoVoxels;
  };
  using Branches = std::vector<std::shared_ptr<const Branch>>;

  explicit VoxelTree(Branches branches);

  template <class Visit>
  void descend(const Place& place, const VoxelCube& cube, const Visit& visit) const {
    for (unsigned index = 0; index < 8; ++index) {
      if ((place.node->full >> index & 1U) != 0) visit(cube.child(index));
      if ((place.node->nodes >> index & 1U) != 0) {
        descend(child(place, index), cube.child(index), visit);
      }
    }
  }

  VoxelCube root_cube_;
  Node root_;
  std::vector<Node> top_;  ///< nodes above the branches; one without octants is branch `first`
  Branches branches_;      ///< in the order of `Branch::order`
  std::uint64_t nodes_ = 1;
  std::uint64_t voxels_ = 0;
  VoxelSet::Range bounds_ = VoxelSet::kNoVoxels;
};

}  // namespace camway::scene
