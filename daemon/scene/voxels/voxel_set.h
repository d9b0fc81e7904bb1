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

/// A set of voxels of a grid, as bits in blocks of 8 x 8 x 8: a look-up costs one of a hash table,
/// and neighbours share what they cost. A value type whose copies share what neither of them
/// changes (`BlockMap`); const calls are safe from any thread.
class VoxelSet {
 public:
  /// Voxels from -kMostVoxels to kMostVoxels - 1 on each axis.
  static constexpr std::int32_t kMostVoxels = std::int32_t{1} << 20;

  /// Of a block: bit y * 8 + x of word z.
  using Bits = std::array<std::uint64_t, 8>;

  /// The first and the last voxel on each axis.
  using Range = std::array<VoxelRange, 3>;
  /// Of no voxels: what `extend` begins with.
  static constexpr Range kNoVoxels{VoxelRange{kMostVoxels, -kMostVoxels},
                                   VoxelRange{kMostVoxels, -kMostVoxels},
                                   VoxelRange{kMostVoxels, -kMostVoxels}};

  /// Whether it was not in the set. Precondition: within kMostVoxels.
  bool insert(const Voxel& voxel);
  /// All voxels of the cube. Precondition: it is aligned to its size, and within kMostVoxels.
  void insert(const VoxelCube& cube);

  [[nodiscard]] bool contains(const Voxel& voxel) const;
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::uint64_t memory_bytes() const { return blocks_.memory_bytes(); }
  /// The same, without what it shares with `other`.
  [[nodiscard]] std::uint64_t memory_bytes_beside(const VoxelSet& other) const {
    return blocks_.memory_bytes_beside(other.blocks_);
  }
  /// Of its voxels; kNoVoxels if it is empty.
  [[nodiscard]] Range bounds() const;

  /// The voxels of a block, which `BlockKey` has the numbers of.
  [[nodiscard]] Bits block(std::uint64_t key) const;
  /// Makes these the voxels of a block.
  void set_block(std::uint64_t key, const Bits& bits);
  /// Those of a block that lie in `range`.
  static Bits bits_in(const Range& range, std::uint64_t key);
  /// Makes `range` hold these voxels of a block, too.
  static void extend(Range& range, std::uint64_t key, const Bits& bits);

  /// Calls `visit` for every voxel, in an order that depends on the set only.
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

  /// Calls `visit` for every block with its lowest voxel and its bits, in such an order. A
  /// block may have no voxels.
  template <class Visit>
  void for_each_block(const Visit& visit) const {
    blocks_.for_each(
        [&](std::uint64_t key, const Bits& bits) { visit(BlockKey::low_of(key), bits); });
  }

  /// Of all blocks, increasing.
  [[nodiscard]] std::vector<std::uint64_t> sorted_keys() const;

  /// Calls `visit(key, old_bits, bits)` for every block that is another one than in `before`. Costs
  /// what was changed since one of the two was a copy of the other.
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

/// Puts voxels into a set, quickly where one is near the one before. For one thread; the set must
/// outlive it, and nothing else change or copy it meanwhile.
class VoxelMarker {
 public:
  explicit VoxelMarker(VoxelSet& set) : set_(set) {}

  /// Both as those of the set. Precondition: within VoxelSet::kMostVoxels.
  bool contains(const Voxel& voxel) { return (word_of(voxel) & bit_of(voxel)) != 0; }
  bool insert(const Voxel& voxel);

 private:
  static std::uint64_t bit_of(const Voxel& voxel) {
    return std::uint64_t{1} << ((voxel[1] & 7) * 8 + (voxel[0] & 7));
  }
  std::uint64_t& word_of(const Voxel& voxel);

  VoxelSet& set_;
  std::uint64_t key_ = 0;
  VoxelSet::Bits* bits_ = nullptr;  ///< of that block
};

}  // namespace camway::scene
