// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "daemon/scene/voxel_grid.h"
#include "daemon/scene/voxel_set.h"

namespace camway::scene {

/// A set of voxels as the octree that OctoMap makes of it: the same cubes, eight full octants
/// always being one full cube. But a node has eight bytes, and stands beside its siblings, so
/// searches wait little for memory. What is no cube of it is nothing to it. Immutable; safe from
/// any thread.
class VoxelTree {
 public:
  /// A cube with voxels and with room, larger than a voxel. Octants as `VoxelCube::child` has them.
  struct Node {
    std::uint32_t first = 0;  ///< of the octants that are nodes again, which stand together
    std::uint8_t nodes = 0;   ///< which octants are
    std::uint8_t full = 0;    ///< which octants are full
  };

  /// Precondition: all voxels are those of a `VoxelGrid`.
  explicit VoxelTree(const VoxelSet& voxels);

  /// No more than what holds all voxels, and never full itself.
  [[nodiscard]] const VoxelCube& root_cube() const { return root_cube_; }
  [[nodiscard]] const Node& root() const { return root_; }
  /// Precondition: octant `index` is a node.
  [[nodiscard]] const Node& child(const Node& node, unsigned index) const {
    const unsigned before = node.nodes & ((1U << index) - 1U);
    return nodes_[node.first + static_cast<unsigned>(std::popcount(before))];
  }

  [[nodiscard]] bool contains(const Voxel& voxel) const;

  /// Calls `visit` for every full cube, octant after octant.
  template <class Visit>
  void for_each_cube(const Visit& visit) const {
    descend(root_, root_cube_, visit);
  }

  /// Nodes and full cubes.
  [[nodiscard]] std::uint64_t node_count() const { return 1 + nodes_.size() + full_cubes_; }
  [[nodiscard]] std::uint64_t memory_bytes() const { return nodes_.capacity() * sizeof(Node); }

 private:
  friend class VoxelTreeBuilder;

  template <class Visit>
  void descend(const Node& node, const VoxelCube& cube, const Visit& visit) const {
    for (unsigned index = 0; index < 8; ++index) {
      if ((node.full >> index & 1U) != 0) visit(cube.child(index));
      if ((node.nodes >> index & 1U) != 0) descend(child(node, index), cube.child(index), visit);
    }
  }

  VoxelCube root_cube_;
  Node root_;
  std::vector<Node> nodes_;
  std::uint64_t full_cubes_ = 0;
};

}  // namespace camway::scene
