// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <unordered_map>
#include <vector>

#include "daemon/scene/voxels/voxel_grid.h"

namespace camway::scene {

/// The number of a block of 8 x 8 x 8 voxels: 19 bits per axis, x lowest, which is enough for the
/// neighbours of all blocks with voxels, too.
class BlockKey {
 public:
  static constexpr std::int32_t kBlockSize = 8;

  /// The key of the block that holds `voxel`. Requires coordinates within 2^20 + 8 of 0.
  static std::uint64_t of(const Voxel& voxel) {
    std::uint64_t key = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
      key = (key << kAxisBits) | static_cast<std::uint64_t>((voxel[axis] >> 3) - kFirst);
    }
    return key;
  }

  /// The lowest voxel of the block.
  static Voxel low_of(std::uint64_t key) {
    Voxel low{};
    for (std::int32_t& coordinate : low) {
      coordinate = (static_cast<std::int32_t>(key & kAxisMask) + kFirst) * kBlockSize;
      key >>= kAxisBits;
    }
    return low;
  }

  /// The first block of the aligned cube of 2^`levels` blocks per edge that holds block `key`.
  static constexpr std::uint64_t first_of_cube(std::uint64_t key, unsigned levels) {
    return key & ~(kLowest * ((std::uint64_t{1} << levels) - 1));
  }

  /// The position of a block, in order of keys, among the 512 of its cube of three levels.
  static constexpr unsigned within_cube(std::uint64_t key) {
    return static_cast<unsigned>((key & 7U) | (key >> kAxisBits & 7U) << 3 |
                                 (key >> (2 * kAxisBits) & 7U) << 6);
  }

  /// The block at position `place` of the cube of three levels whose first block is `first`.
  static constexpr std::uint64_t in_cube(std::uint64_t first, unsigned place) {
    const std::uint64_t at = place;
    return first | (at & 7U) | (at >> 3 & 7U) << kAxisBits | (at >> 6) << (2 * kAxisBits);
  }

 private:
  static constexpr unsigned kAxisBits = 19;
  static constexpr std::uint64_t kAxisMask = (std::uint64_t{1} << kAxisBits) - 1;
  static constexpr std::int32_t kFirst = -(std::int32_t{1} << (kAxisBits - 1));
  static constexpr std::uint64_t kLowest =
      1 | std::uint64_t{1} << kAxisBits | std::uint64_t{1} << (2 * kAxisBits);
};

/// A map from block keys to blocks. It stores regions of 8 x 8 x 8 blocks, which copies share until
/// one of them changes a block there (copy on write). So the cost of a copy depends on the number
/// of regions, and the cost of a change depends on the number of blocks in its region. A value
/// type. Const calls, and copying, are thread-safe.
template <class Block>
class BlockMap {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }

  /// The block, or null if there is none.
  [[nodiscard]] const Block* find(std::uint64_t key) const {
    const auto found = regions_.find(region_of(key));
    return found == regions_.end() ? nullptr : found->second->find(BlockKey::within_cube(key));
  }

  /// The block, for changing it; inserted as `Block{}` if there is none. Valid until the next call
  /// of `at` and until the map is copied.
  Block& at(std::uint64_t key) {
    std::shared_ptr<Region>& region = regions_[region_of(key)];
    if (!region) {
      region = std::make_shared<Region>();
    } else if (region.use_count() > 1) {
      region = std::make_shared<Region>(*region);
    }
    const unsigned place = BlockKey::within_cube(key);
    if (region->find(place) == nullptr) {
      region->add(place);
      ++size_;
    }
    return region->get(place);
  }

  /// Calls `visit(key, block)` for every block. The order depends on the keys only.
  template <class Visit>
  void for_each(const Visit& visit) const {
    std::vector<std::uint64_t> firsts;
    firsts.reserve(regions_.size());
    for (const auto& [first, region] : regions_) firsts.push_back(first);
    std::ranges::sort(firsts);
    for (const std::uint64_t first : firsts) {
      regions_.find(first)->second->for_each([&](unsigned place, const Block& block) {
        visit(BlockKey::in_cube(first, place), block);
      });
    }
  }

  /// Calls `visit(key, before, now)` for every block of the regions that this map and `before` do
  /// not share, with null for a block that is missing in one of them. The order depends on the keys
  /// only. The cost depends on the number of regions, and of blocks in those that are not shared.
  template <class Visit>
  void for_each_unshared(const BlockMap& before, const Visit& visit) const {
    std::set<std::uint64_t> firsts;
    for (const auto& [first, region] : regions_) {
      if (before.region(first) != region.get()) firsts.insert(first);
    }
    for (const auto& [first, region] : before.regions_) {
      if (this->region(first) != region.get()) firsts.insert(first);
    }
    for (const std::uint64_t first : firsts) {
      const Region* const old = before.region(first);
      const Region* const now = region(first);
      for (unsigned place = 0; place < Region::kBlocks; ++place) {
        const Block* const old_block = old != nullptr ? old->find(place) : nullptr;
        const Block* const block = now != nullptr ? now->find(place) : nullptr;
        if (old_block == nullptr && block == nullptr) continue;
        visit(BlockKey::in_cube(first, place), old_block, block);
      }
    }
  }

  /// Memory of blocks and tables, without memory that blocks refer to.
  [[nodiscard]] std::uint64_t memory_bytes() const { return memory_bytes_beside({}); }
  /// The part of `memory_bytes` that is not in regions shared with `other`.
  [[nodiscard]] std::uint64_t memory_bytes_beside(const BlockMap& other) const {
    constexpr std::uint64_t kOfATableEntry = 8 * sizeof(void*);
    std::uint64_t bytes = regions_.size() * kOfATableEntry;
    for (const auto& [first, region] : regions_) {
      if (other.region(first) != region.get()) bytes += region->memory_bytes();
    }
    return bytes;
  }

 private:
  /// The existing blocks of a cube of 8 x 8 x 8.
  class Region {
   public:
    static constexpr unsigned kBlocks = 512;

    [[nodiscard]] const Block* find(unsigned place) const {
      return (present_[place / 64] >> place % 64 & 1U) != 0 ? &blocks_[rank(place)] : nullptr;
    }
    /// Requires that the block exists.
    Block& get(unsigned place) { return blocks_[rank(place)]; }
    /// Requires that the block does not exist.
    void add(unsigned place) {
      blocks_.insert(blocks_.begin() + static_cast<std::ptrdiff_t>(rank(place)), Block{});
      present_[place / 64] |= std::uint64_t{1} << place % 64;
      for (unsigned word = place / 64 + 1; word < before_.size(); ++word) ++before_[word];
    }

    template <class Visit>
    void for_each(const Visit& visit) const {
      std::size_t next = 0;
      for (unsigned word = 0; word < present_.size(); ++word) {
        for (std::uint64_t left = present_[word]; left != 0; left &= left - 1) {
          visit(64 * word + static_cast<unsigned>(std::countr_zero(left)), blocks_[next++]);
        }
      }
    }

    [[nodiscard]] std::uint64_t memory_bytes() const {
      return sizeof *this + blocks_.capacity() * sizeof(Block);
    }

   private:
    /// Number of existing blocks before `place`.
    [[nodiscard]] std::size_t rank(unsigned place) const {
      const std::uint64_t below = (std::uint64_t{1} << place % 64) - 1;
      return before_[place / 64] +
             static_cast<std::size_t>(std::popcount(present_[place / 64] & below));
    }

    std::array<std::uint64_t, kBlocks / 64> present_{};
    std::array<std::uint16_t, kBlocks / 64> before_{};  ///< number of blocks in all words before
    std::vector<Block> blocks_;                         ///< existing blocks in order of places
  };

  static std::uint64_t region_of(std::uint64_t key) { return BlockKey::first_of_cube(key, 3); }

  [[nodiscard]] const Region* region(std::uint64_t first) const {
    const auto found = regions_.find(first);
    return found == regions_.end() ? nullptr : found->second.get();
  }

  std::unordered_map<std::uint64_t, std::shared_ptr<Region>> regions_;
  std::size_t size_ = 0;
};

}  // namespace camway::scene
