// SPDX-License-Identifier: MIT
#include "daemon/scene/voxel_tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>

namespace camway::scene {
namespace {

constexpr std::int32_t kBlockSize = 8;

/// A block of the set where the tree has it.
struct Block {
  std::uint64_t order;  ///< the bits of its coordinates in turn: octant after octant
  Voxel low;
  const VoxelSet::Bits* bits;
};

/// Every third bit of the result is one of `bits`.
std::uint64_t spread(std::uint32_t bits) {
  std::uint64_t result = 0;
  for (unsigned i = 0; i < 16; ++i) result |= static_cast<std::uint64_t>(bits >> i & 1U) << (3 * i);
  return result;
}

std::uint64_t order_of(const Voxel& low) {
  std::uint64_t order = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const std::int32_t above = low[axis] - VoxelGrid::kMinVoxel;
    assert(above >= 0 && above < VoxelGrid::kRoot.size);
    order |= spread(static_cast<std::uint32_t>(above / kBlockSize)) << axis;
  }
  return order;
}

std::vector<Block> ordered_blocks(const VoxelSet& voxels) {
  std::vector<Block> blocks;
  voxels.for_each_block([&](const Voxel& low, const VoxelSet::Bits& bits) {
    if (bits != VoxelSet::Bits{}) blocks.push_back({order_of(low), low, &bits});
  });
  std::ranges::sort(blocks, {}, &Block::order);
  return blocks;
}

}  // namespace

/// Makes the tree from its leaves up: the octants of a node are known before the node is.
class VoxelTreeBuilder {
 public:
  explicit VoxelTreeBuilder(VoxelTree& tree) : tree_(tree) {}

  void build(std::span<const Block> blocks) {
    if (blocks.empty()) return;
    // One level above the least that holds all, so that this may be full.
    const std::uint64_t differing = blocks.front().order ^ blocks.back().order;
    const unsigned levels =
        std::min(13U, (static_cast<unsigned>(std::bit_width(differing)) + 2) / 3 + 1);
    VoxelCube& cube = tree_.root_cube_;
    cube.size = kBlockSize << levels;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t above = blocks.front().low[axis] - VoxelGrid::kMinVoxel;
      cube.min[axis] = (above & ~(cube.size - 1)) + VoxelGrid::kMinVoxel;
    }
    const Part root = of_blocks(blocks, levels);
    assert(!root.full);
    tree_.root_ = root.node;
  }

 private:
  /// What a cube is.
  struct Part {
    bool full = false;
    VoxelTree::Node node;  ///< without octants: the cube is empty, or full

    [[nodiscard]] bool is_node() const { return (node.nodes | node.full) != 0; }
  };
  using Octants = std::array<Part, 8>;

  /// Of the blocks of a cube of 2^levels blocks per edge.
  Part of_blocks(std::span<const Block> blocks, unsigned levels) {
    if (blocks.empty()) return {};
    if (levels == 0) return of_bits(*blocks.front().bits, {0, 0, 0}, kBlockSize);
    Octants octants;
    for (std::uint64_t index = 0; index < 8; ++index) {
      const auto end = std::ranges::find_if(blocks, [&](const Block& block) {
        return (block.order >> (3 * (levels - 1)) & 7U) != index;
      });
      const auto count = static_cast<std::size_t>(end - blocks.begin());
      octants[index] = of_blocks(blocks.first(count), levels - 1);
      blocks = blocks.subspan(count);
    }
    return join(octants);
  }

  /// Of a cube of a block that begins at `at`.
  Part of_bits(const VoxelSet::Bits& bits, const std::array<unsigned, 3>& at, unsigned size) {
    if (size == 2) return of_voxels(bits, at);
    const unsigned half = size / 2;
    Octants octants;
    for (unsigned i = 0; i < 8; ++i) {
      octants[i] = of_bits(
          bits, {at[0] + (i & 1U) * half, at[1] + (i >> 1 & 1U) * half, at[2] + (i >> 2) * half},
          half);
    }
    return join(octants);
  }

  static Part of_voxels(const VoxelSet::Bits& bits, const std::array<unsigned, 3>& at) {
    std::uint64_t full = 0;
    for (unsigned z = 0; z < 2; ++z) {
      const std::uint64_t rows = bits[at[2] + z] >> (8 * at[1] + at[0]);
      full |= ((rows & 3U) | (rows >> 8 & 3U) << 2) << (4 * z);
    }
    return part({0, 0, static_cast<std::uint8_t>(full)});
  }

  Part join(const Octants& octants) {
    VoxelTree::Node node;
    node.first = static_cast<std::uint32_t>(tree_.nodes_.size());
    for (unsigned index = 0; index < 8; ++index) {
      const auto bit = static_cast<std::uint8_t>(1U << index);
      if (octants[index].full) node.full |= bit;
      if (!octants[index].is_node()) continue;
      node.nodes |= bit;
      tree_.nodes_.push_back(octants[index].node);
    }
    return part(node);
  }

  static Part part(const VoxelTree::Node& node) {
    if (node.full == 0xFF) return {true, {}};
    return {false, node};
  }

  VoxelTree& tree_;
};

VoxelTree::VoxelTree(const VoxelSet& voxels) {
  VoxelTreeBuilder(*this).build(ordered_blocks(voxels));
  nodes_.shrink_to_fit();
  for_each_cube([this](const VoxelCube&) { ++full_cubes_; });
}

bool VoxelTree::contains(const Voxel& voxel) const {
  std::array<std::uint32_t, 3> within{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Below the cube becomes far above it.
    within[axis] =
        static_cast<std::uint32_t>(voxel[axis]) - static_cast<std::uint32_t>(root_cube_.min[axis]);
    if (within[axis] >= static_cast<std::uint32_t>(root_cube_.size)) return false;
  }
  const Node* node = &root_;
  for (auto half = static_cast<std::uint32_t>(root_cube_.size) / 2;; half /= 2) {
    unsigned index = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      if ((within[axis] & half) != 0) index |= 1U << axis;
    }
    if ((node->full >> index & 1U) != 0) return true;
    if ((node->nodes >> index & 1U) == 0) return false;
    node = &child(*node, index);
  }
}

}  // namespace camway::scene
