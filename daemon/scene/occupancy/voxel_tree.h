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

/// A set of voxels as the octree that OctoMap makes of it: the same cubes, eight full octants
/// always being one full cube. But a node has eight bytes, and stands beside its siblings, so
/// searches wait little for memory. What is no cube of it is nothing to it. Where the set changes,
/// the next tree shares the branches in which nothing did. Immutable; safe from any thread.
class VoxelTree {
 public:
  /// A cube with voxels and with room, larger than a voxel. Octants as `VoxelCube::child` has them.
  struct Node {
    std::uint32_t first = 0;  ///< of the octants that are nodes again, which stand together
    std::uint8_t nodes = 0;   ///< which octants are
    std::uint8_t full = 0;    ///< which octants are full
  };

  /// A node, and where its octants are found.
  struct Place {
    const Node* node;
    const Node* nodes;
  };

  /// Precondition: all voxels are those of a `VoxelGrid`. A stop that is asked for meanwhile leaves
  /// voxels out: then the tree is of no use.
  explicit VoxelTree(const VoxelSet& voxels, const std::stop_token& stop = {});

  /// The tree of `after`, if this one is that of `before`. The same holds of a stop.
  [[nodiscard]] VoxelTree updated(const VoxelSet& before, const VoxelSet& after,
                                  const std::stop_token& stop = {}) const;

  /// Holds all voxels, and is never full itself.
  [[nodiscard]] const VoxelCube& root_cube() const { return root_cube_; }
  [[nodiscard]] Place root() const { return {&root_, top_.data()}; }
  /// Precondition: octant `index` of that node is a node.
  [[nodiscard]] Place child(const Place& place, unsigned index) const {
    const unsigned before = place.node->nodes & ((1U << index) - 1U);
    const Node* const node =
        place.nodes + place.node->first + static_cast<unsigned>(std::popcount(before));
    if ((node->nodes | node->full) != 0) return {node, place.nodes};
    const Branch& branch = *branches_[node->first];
    return {&branch.root, branch.nodes.data()};
  }

  [[nodiscard]] bool contains(const Voxel& voxel) const;

  /// Calls `visit` for every full cube, octant after octant.
  template <class Visit>
  void for_each_cube(const Visit& visit) const {
    descend(root(), root_cube_, visit);
  }

  [[nodiscard]] std::uint64_t voxels() const { return voxels_; }
  /// Of its voxels; VoxelSet::kNoVoxels if it has none.
  [[nodiscard]] const VoxelSet::Range& bounds() const { return bounds_; }
  /// Nodes and full cubes.
  [[nodiscard]] std::uint64_t node_count() const { return nodes_; }
  /// Branches count where they are shared, too.
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  friend class BranchBuilder;
  friend class VoxelTreeTop;

  /// Blocks of a branch along an edge are 2^kBranchLevels.
  static constexpr unsigned kBranchLevels = 3;

  /// What is in a cube of 64 x 64 x 64 voxels, not nothing.
  struct Branch {
    std::uint64_t key = 0;    ///< of its first block (`BlockKey`)
    std::uint64_t order = 0;  ///< the bits of its coordinates in turn: octant after octant
    Node root;                ///< all octants are full: the cube is
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
  std::vector<Node> top_;  ///< above the branches; one without octants is branch `first`
  Branches branches_;      ///< in their order
  std::uint64_t nodes_ = 1;
  std::uint64_t voxels_ = 0;
  VoxelSet::Range bounds_ = VoxelSet::kNoVoxels;
};

}  // namespace camway::scene
