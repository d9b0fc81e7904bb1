// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

namespace camway::correction {

/// A cell of a cubic lattice. [Range: the absolute value of each coordinate is below
/// `kFarthestCell`]
using Cell = std::array<std::int32_t, 3>;
/// A cell packed into one number, never 0. The difference of the keys of two cells, added to the
/// key of a third one, gives the key of the cell that is displaced from it by the same step.
using CellKey = std::uint64_t;

inline constexpr std::int32_t kFarthestCell = (1 << 20) - 1;
inline constexpr int kCellKeyBits = 21;  // bits per coordinate, so that a key takes 63

constexpr CellKey key_of(const Cell& cell) {
  CellKey key = 0;
  for (const std::int32_t c : cell) {
    key = (key << kCellKeyBits) | static_cast<CellKey>(c + kFarthestCell);
  }
  return key;
}

constexpr Cell cell_of(CellKey key) {
  constexpr CellKey kMask = (CellKey{1} << kCellKeyBits) - 1;
  const auto number = [&](int place) {
    return static_cast<std::int32_t>(key >> (place * kCellKeyBits) & kMask) - kFarthestCell;
  };
  return {number(2), number(1), number(0)};
}

/// The 27 steps from a cell to itself and its neighbours, x fastest: step i leads by (i mod 3 - 1,
/// i / 3 mod 3 - 1, i / 9 - 1); step `kCellSteps - 1 - i` is its inverse.
inline constexpr std::size_t kCellSteps = 27;
inline constexpr std::size_t kNoStep = 13;  ///< the step that stays at the cell

/// Difference of keys for each step.
inline constexpr std::array<CellKey, kCellSteps> kKeySteps = [] {
  std::array<CellKey, kCellSteps> steps{};
  for (int i = 0; i < static_cast<int>(kCellSteps); ++i) {
    steps[static_cast<std::size_t>(i)] =
        key_of({i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}) - key_of({0, 0, 0});
  }
  return steps;
}();

/// A map from cells to numbers, stored in cubic blocks of cells, so that a cell and its neighbours
/// are in one block or few. Not thread-safe.
class CellNumbers {
  static constexpr int kBits = 2;
  static constexpr std::int32_t kSide = 1 << kBits;  // side of a block, in cells
  using Block = std::array<std::uint32_t, kSide * kSide * kSide>;

 public:
  /// The number of a cell without one.
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// The numbers of a cell and its neighbours, indexed by step. Valid as long as the map.
  class Around {
   public:
    [[nodiscard]] std::uint32_t& operator[](std::size_t step) const {
      const auto at = static_cast<std::int32_t>(step);
      const std::int32_t x = low_[0] + at % 3;
      const std::int32_t y = low_[1] + at / 3 % 3;
      const std::int32_t z = low_[2] + at / 9;
      const std::int32_t block = x >> kBits | (y >> kBits) << 1 | (z >> kBits) << 2;
      constexpr std::int32_t kMask = kSide - 1;
      const std::int32_t place = (x & kMask) | (y & kMask) << kBits | (z & kMask) << (2 * kBits);
      return (*blocks_[static_cast<std::size_t>(block)])[static_cast<std::size_t>(place)];
    }

   private:
    friend class CellNumbers;
    Cell low_;  ///< the first of the 27 cells, relative to the first block
    std::array<Block*, 8> blocks_;
  };

  /// Requires the neighbours of `cell` to be in range, too.
  [[nodiscard]] Around around(const Cell& cell) {
    Around result;
    Cell first;  // first block
    Cell last;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first[axis] = (cell[axis] - 1) >> kBits;
      last[axis] = (cell[axis] + 1) >> kBits;
      result.low_[axis] = cell[axis] - 1 - first[axis] * kSide;
    }
    for (std::int32_t z = first[2]; z <= last[2]; ++z) {
      for (std::int32_t y = first[1]; y <= last[1]; ++y) {
        for (std::int32_t x = first[0]; x <= last[0]; ++x) {
          const std::int32_t block = (x - first[0]) | (y - first[1]) << 1 | (z - first[2]) << 2;
          result.blocks_[static_cast<std::size_t>(block)] = &block_at(key_of({x, y, z}));
        }
      }
    }
    return result;
  }

 private:
  struct Slot {
    CellKey key = 0;  ///< key of the block, by its coordinates in units of blocks
    Block* block = nullptr;
  };

  Block& block_at(CellKey key) {
    Slot& slot = slot_of(key);
    if (slot.key == key) return *slot.block;
    blocks_.emplace_back().fill(kNone);
    slot = {key, &blocks_.back()};
    if (2 * blocks_.size() > slots_.size()) grow();
    return blocks_.back();
  }

  /// The slot of `key`, or the free slot where it belongs (open addressing).
  Slot& slot_of(CellKey key) {
    constexpr CellKey kMixer = 0x9E3779B97F4A7C15U;  // 2^64 by the golden ratio (Knuth)
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (key * kMixer) >> 32U & mask;
    while (slots_[at].key != 0 && slots_[at].key != key) at = (at + 1) & mask;
    return slots_[at];
  }

  void grow() {
    const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
    for (const Slot& slot : old) {
      if (slot.key != 0) slot_of(slot.key) = slot;
    }
  }

  std::deque<Block> blocks_;                          ///< a deque, so that blocks stay in place
  std::vector<Slot> slots_ = std::vector<Slot>(128);  // always a power of two
};

}  // namespace camway::correction
