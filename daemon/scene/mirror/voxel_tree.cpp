// SPDX-License-Identifier: MIT
#include "daemon/scene/mirror/voxel_tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <set>
#include <span>
#include <utility>

namespace camway::scene {
namespace {

using Node = VoxelTree::Node;

/// Spreads `bits` to every third bit of the result.
std::uint64_t spread(std::uint32_t bits) {
  std::uint64_t result = 0;
  for (unsigned i = 0; i < 16; ++i) result |= static_cast<std::uint64_t>(bits >> i & 1U) << (3 * i);
  return result;
}

/// The Morton code of a block: its position in the order of the tree.
std::uint64_t order_of(std::uint64_t key) {
  const Voxel low = BlockKey::low_of(key);
  std::uint64_t order = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const std::int32_t above = low[axis] - VoxelGrid::kMinVoxel;
    assert(above >= 0 && above < VoxelGrid::kRoot.size);
    order |= spread(static_cast<std::uint32_t>(above / BlockKey::kBlockSize)) << axis;
  }
  return order;
}

/// The content of a cube: full, a node, or empty.
struct Part {
  bool full = false;
  Node node;  ///< has no octants if the cube is empty or full

  [[nodiscard]] bool is_node() const { return (node.nodes | node.full) != 0; }
};

using Octants = std::array<Part, 8>;

Part part_of(const Node& node) {
  if (node.full == 0xFF) return {true, {}};
  return {false, node};
}

/// Appends the octants that are nodes to `nodes`, and returns the node above them.
Part join(const Octants& octants, std::vector<Node>& nodes) {
  Node node;
  node.first = static_cast<std::uint32_t>(nodes.size());
  for (unsigned index = 0; index < 8; ++index) {
    const auto bit = static_cast<std::uint8_t>(1U << index);
    if (octants[index].full) node.full |= bit;
    if (!octants[index].is_node()) continue;
    node.nodes |= bit;
    nodes.push_back(octants[index].node);
  }
  return part_of(node);
}

}  // namespace

/// Builds a branch from its leaves up: the octants of a node are known before the node.
class BranchBuilder {
 public:
  /// Returns null if the branch is empty.
  static std::shared_ptr<const VoxelTree::Branch> build(const VoxelSet& voxels, std::uint64_t key) {
    auto branch = std::make_shared<VoxelTree::Branch>();
    branch->key = key;
    const Part root = BranchBuilder(voxels, *branch).of_blocks(0, VoxelTree::kBranchLevels);
    if (!root.full && !root.is_node()) return nullptr;
    branch->order = order_of(key) >> (3 * VoxelTree::kBranchLevels);
    branch->root = root.node;
    if (root.full) branch->root.full = 0xFF;
    branch->nodes.shrink_to_fit();
    branch->full_cubes += static_cast<unsigned>(std::popcount(branch->root.full));
    for (const Node& node : branch->nodes) {
      branch->full_cubes += static_cast<unsigned>(std::popcount(node.full));
    }
    return branch;
  }

 private:
  BranchBuilder(const VoxelSet& voxels, VoxelTree::Branch& branch)
      : voxels_(voxels), branch_(branch) {}

  /// Builds a cube of 2^levels blocks per edge that begins with block `place` of the branch.
  Part of_blocks(unsigned place, unsigned levels) {
    if (levels == 0) return of_block(BlockKey::in_cube(branch_.key, place));
    Octants octants;
    const unsigned half = 1U << (levels - 1);
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned corner = ((i & 1U) | (i >> 1 & 1U) << 3 | (i >> 2) << 6) * half;
      octants[i] = of_blocks(place + corner, levels - 1);
    }
    return join(octants, branch_.nodes);
  }

  Part of_block(std::uint64_t key) {
    const VoxelSet::Bits bits = voxels_.block(key);
    if (bits == VoxelSet::Bits{}) return {};
    VoxelSet::extend(branch_.bounds, key, bits);
    for (const std::uint64_t slice : bits) {
      branch_.voxels += static_cast<unsigned>(std::popcount(slice));
    }
    return of_bits(bits, {0, 0, 0}, BlockKey::kBlockSize);
  }

  /// Builds a cube of `size` voxels per edge that begins at voxel `at` of a block.
  Part of_bits(const VoxelSet::Bits& bits, const std::array<unsigned, 3>& at, unsigned size) {
    if (size == 2) return of_voxels(bits, at);
    const unsigned half = size / 2;
    Octants octants;
    for (unsigned i = 0; i < 8; ++i) {
      octants[i] = of_bits(
          bits, {at[0] + (i & 1U) * half, at[1] + (i >> 1 & 1U) * half, at[2] + (i >> 2) * half},
          half);
    }
    return join(octants, branch_.nodes);
  }

  static Part of_voxels(const VoxelSet::Bits& bits, const std::array<unsigned, 3>& at) {
    std::uint64_t full = 0;
    for (unsigned z = 0; z < 2; ++z) {
      const std::uint64_t rows = bits[at[2] + z] >> (8 * at[1] + at[0]);
      full |= ((rows & 3U) | (rows >> 8 & 3U) << 2) << (4 * z);
    }
    return part_of({0, 0, static_cast<std::uint8_t>(full)});
  }

  const VoxelSet& voxels_;
  VoxelTree::Branch& branch_;
};

/// Builds the nodes above the branches.
class VoxelTreeTop {
 public:
  explicit VoxelTreeTop(VoxelTree& tree) : tree_(tree) {}

  void build() {
    const VoxelTree::Branches& branches = tree_.branches_;
    if (branches.empty()) return;
    // One level above the smallest cube that contains all branches, since that cube may be full.
    const std::uint64_t differing = branches.front()->order ^ branches.back()->order;
    constexpr unsigned kMostLevels = 13 - VoxelTree::kBranchLevels;
    const unsigned levels =
        std::min(kMostLevels, (static_cast<unsigned>(std::bit_width(differing)) + 2) / 3 + 1);
    VoxelCube& cube = tree_.root_cube_;
    cube.size = BlockKey::kBlockSize << (levels + VoxelTree::kBranchLevels);
    const Voxel first = BlockKey::low_of(branches.front()->key);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t above = first[axis] - VoxelGrid::kMinVoxel;
      cube.min[axis] = (above & ~(cube.size - 1)) + VoxelGrid::kMinVoxel;
    }
    const Part root = of_branches(0, branches.size(), levels);
    assert(!root.full);
    tree_.root_ = root.node;
  }

 private:
  /// Builds a cube of 2^levels branches per edge that contains those from `begin` to `end`.
  Part of_branches(std::size_t begin, std::size_t end, unsigned levels) {
    const VoxelTree::Branches& branches = tree_.branches_;
    std::vector<Node> nodes;
    Node node;
    std::size_t next = begin;
    for (std::uint64_t index = 0; index < 8; ++index) {
      const std::size_t first = next;
      while (next < end && (branches[next]->order >> (3 * (levels - 1)) & 7U) == index) ++next;
      if (first == next) continue;
      const Part part = levels == 1 ? Part{branches[first]->root.full == 0xFF, {}}
                                    : of_branches(first, next, levels - 1);
      const auto bit = static_cast<std::uint8_t>(1U << index);
      if (part.full) {
        node.full |= bit;
        continue;
      }
      node.nodes |= bit;
      nodes.push_back(levels == 1 ? Node{static_cast<std::uint32_t>(first), 0, 0} : part.node);
    }
    node.first = static_cast<std::uint32_t>(tree_.top_.size());
    tree_.top_.insert(tree_.top_.end(), nodes.begin(), nodes.end());
    return part_of(node);
  }

  VoxelTree& tree_;
};

VoxelTree::VoxelTree(Branches branches) : branches_(std::move(branches)) {
  VoxelTreeTop(*this).build();
  const auto count_full = [this](const Node& node) {
    nodes_ += static_cast<unsigned>(std::popcount(node.full));
  };
  count_full(root_);
  for (const Node& node : top_) count_full(node);
  nodes_ += top_.size();
  for (const std::shared_ptr<const Branch>& branch : branches_) {
    voxels_ += branch->voxels;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bounds_[axis].first = std::min(bounds_[axis].first, branch->bounds[axis].first);
      bounds_[axis].last = std::max(bounds_[axis].last, branch->bounds[axis].last);
    }
    if (branch->root.full != 0xFF) nodes_ += branch->nodes.size() + branch->full_cubes;
  }
}

VoxelTree::VoxelTree(const VoxelSet& voxels, const std::stop_token& stop)
    : VoxelTree(VoxelTree(Branches{}).updated({}, voxels, stop)) {}

VoxelTree VoxelTree::updated(const VoxelSet& before, const VoxelSet& after,
                             const std::stop_token& stop) const {
  std::set<std::uint64_t> touched;
  after.for_each_difference(before, [&](std::uint64_t key, const auto&, const auto&) {
    if (stop.stop_requested()) return;
    touched.insert(BlockKey::first_of_cube(key, kBranchLevels));
  });
  Branches branches;
  branches.reserve(branches_.size() + touched.size());
  for (const std::shared_ptr<const Branch>& branch : branches_) {
    if (!touched.contains(branch->key)) branches.push_back(branch);
  }
  for (const std::uint64_t key : touched) {
    if (stop.stop_requested()) break;
    if (auto branch = BranchBuilder::build(after, key)) branches.push_back(std::move(branch));
  }
  std::ranges::sort(branches, {}, [](const auto& branch) { return branch->order; });
  branches.shrink_to_fit();  // so that the memory does not depend on the tree's history
  return VoxelTree(std::move(branches));
}

std::uint64_t VoxelTree::memory_bytes() const {
  std::uint64_t bytes =
      top_.capacity() * sizeof(Node) + branches_.capacity() * sizeof(branches_[0]);
  for (const std::shared_ptr<const Branch>& branch : branches_) {
    bytes += sizeof(Branch) + branch->nodes.capacity() * sizeof(Node);
  }
  return bytes;
}

bool VoxelTree::contains(const Voxel& voxel) const {
  std::array<std::uint32_t, 3> within{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Unsigned differences: a voxel below the cube counts as far above it.
    within[axis] =
        static_cast<std::uint32_t>(voxel[axis]) - static_cast<std::uint32_t>(root_cube_.min[axis]);
    if (within[axis] >= static_cast<std::uint32_t>(root_cube_.size)) return false;
  }
  Place place = root();
  for (auto half = static_cast<std::uint32_t>(root_cube_.size) / 2;; half /= 2) {
    unsigned index = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      if ((within[axis] & half) != 0) index |= 1U << axis;
    }
    if ((place.node->full >> index & 1U) != 0) return true;
    if ((place.node->nodes >> index & 1U) == 0) return false;
    place = child(place, index);
  }
}

}  // namespace camway::scene
