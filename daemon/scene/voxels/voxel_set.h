// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/scene/voxels/block_map.h"
#include "daemon/scene/voxels/voxel_grid.h"

namespace camway::scene {

/// A set of voxels, stored as bits in blocks of 8 x 8 x 8. A look-up needs one look-up in a hash
/// table; look-ups of neighbours can share it. Copies share the regions that neither of them
/// changes (`BlockMap`). A value type. Const calls are thread-safe.
class VoxelSet {
 public:
  /// Voxels lie between -kMostVoxels and kMostVoxels - 1 on each axis.
  static constexpr std::int32_t kMostVoxels = std::int32_t{1} << 20;

  /// The voxels of a block: voxel (x, y, z) is bit y * 8 + x of word z.
  using Bits = std::array<std::uint64_t, 8>;

  /// The first and the last voxel on each axis.
  using Range = std::array<VoxelRange, 3>;
  /// The range without voxels, with which `extend` begins.
  static constexpr Range kNoVoxels{VoxelRange{kMostVoxels, -kMostVoxels},
                                   VoxelRange{kMostVoxels, -kMostVoxels},
                                   VoxelRange{kMostVoxels, -kMostVoxels}};

  /// Inserts a voxel; returns whether it was new. Requires a voxel within kMostVoxels.
  bool insert(const Voxel& voxel);
  /// Inserts all voxels of a cube. Requires a cube aligned to its size and within kMostVoxels.
  void insert(const VoxelCube& cube);

  [[nodiscard]] bool contains(const Voxel& voxel) const;
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// Number of blocks, of which some may have no voxels.
  [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }
  [[nodiscard]] std::uint64_t memory_bytes() const { return blocks_.memory_bytes(); }
  /// The part of `memory_bytes` that is not shared with `other`.
  [[nodiscard]] std::uint64_t memory_bytes_beside(const VoxelSet& other) const {
    return blocks_.memory_bytes_beside(other.blocks_);
  }
  /// The range of its voxels; kNoVoxels if it is empty.
  [[nodiscard]] Range bounds() const;

  /// The voxels of the block with this `BlockKey`.
  [[nodiscard]] Bits block(std::uint64_t key) const;
  /// Replaces the voxels of a block.
  void set_block(std::uint64_t key, const Bits& bits);
  /// The voxels of a block that lie in `range`.
  static Bits bits_in(const Range& range, std::uint64_t key);
  /// Extends `range` to contain the voxels `bits` of a block.
  static void extend(Range& range, std::uint64_t key, const Bits& bits);

  /// Calls `visit` for every voxel. The order depends on the set only.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for_each_block([&](const Voxel& low, const Bits& bits) {
      for (std::int32_t z = 0; z < 8; ++z) {
        for (std::uint64_t left = bits[static_cast<std::size_t>(z)]; left != 0; left &= left - 1) {
          const int bit = std::countr_zero(left);
          visit(Voxel{low[0] + bit % 8, low[1] + bit / 8, low[2] + z});
        }
      }
    });
  }

  /// Calls `visit(lowest voxel, bits)` for every block, in an order that depends on the set only. A
  /// block may have no voxels.
  template <class Visit>
  void for_each_block(const Visit& visit) const {
    blocks_.for_each(
        [&](std::uint64_t key, const Bits& bits) { visit(BlockKey::low_of(key), bits); });
  }

  /// The keys of all blocks, increasing.
  [[nodiscard]] std::vector<std::uint64_t> sorted_keys() const;

  /// Calls `visit(key, old_bits, bits)` for every block that differs from that in `before`. The
  /// cost depends on the changes since one of the two sets was a copy of the other.
  template <class Visit>
  void for_each_difference(const VoxelSet& before, const Visit& visit) const {
    blocks_.for_each_unshared(before.blocks_,
                              [&](std::uint64_t key, const Bits* old_bits, const Bits* bits) {
                                const Bits old = old_bits != nullptr ? *old_bits : Bits{};
                                const Bits now = bits != nullptr ? *bits : Bits{};
                                if (old != now) visit(key, old, now);
                              });
  }

 private:
  friend class VoxelMarker;

  void add(std::uint64_t key, const Bits& bits);

  BlockMap<Bits> blocks_;
  std::uint64_t size_ = 0;
};

/// Inserts voxels into a set, quickly if each is near the one before. The set must outlive it, and
/// nothing else may change or copy the set meanwhile. Not thread-safe.
class VoxelMarker {
 public:
  explicit VoxelMarker(VoxelSet& set) : set_(set) {}

  /// `contains` and `insert` as in `VoxelSet`. Require a voxel within VoxelSet::kMostVoxels.
  bool contains(const Voxel& voxel) { return (word_of(voxel) & bit_of(voxel)) != 0; }
  bool insert(const Voxel& voxel);

 private:
  static std::uint64_t bit_of(const Voxel& voxel) {
    return std::uint64_t{1} << ((voxel[1] & 7) * 8 + (voxel[0] & 7));
  }
  std::uint64_t& word_of(const Voxel& voxel);

  VoxelSet& set_;
  std::uint64_t key_ = 0;
  VoxelSet::Bits* bits_ = nullptr;  ///< block `key_` of the set
};

}  // namespace camway::scene
