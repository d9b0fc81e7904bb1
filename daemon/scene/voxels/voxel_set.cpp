// SPDX-License-Identifier: MIT
#include "daemon/scene/voxels/voxel_set.h"

#include <algorithm>

namespace camway::scene {
namespace {

/// The bits of a row of eight voxels, beginning with voxel `low`, that lie in `range`.
std::uint64_t row_in(const VoxelRange& range, std::int32_t low) {
  std::uint64_t bits = 0;
  for (std::int32_t i = 0; i < 8; ++i) {
    if (low + i >= range.first && low + i <= range.last) bits |= std::uint64_t{1} << i;
  }
  return bits;
}

}  // namespace

std::vector<std::uint64_t> VoxelSet::sorted_keys() const {
  std::vector<std::uint64_t> keys;
  keys.reserve(blocks_.size());
  blocks_.for_each([&](std::uint64_t key, const Bits&) { keys.push_back(key); });
  std::ranges::sort(keys);
  return keys;
}

VoxelSet::Bits VoxelSet::block(std::uint64_t key) const {
  const Bits* const bits = blocks_.find(key);
  return bits != nullptr ? *bits : Bits{};
}

void VoxelSet::set_block(std::uint64_t key, const Bits& bits) {
  const Bits* const old = blocks_.find(key);
  if (old == nullptr ? bits == Bits{} : bits == *old) return;  // leaves a shared region as it is
  Bits& block = blocks_.at(key);
  for (std::size_t z = 0; z < block.size(); ++z) {
    size_ += static_cast<std::uint64_t>(std::popcount(bits[z]));
    size_ -= static_cast<std::uint64_t>(std::popcount(block[z]));
  }
  block = bits;
}

VoxelSet::Bits VoxelSet::bits_in(const Range& range, std::uint64_t key) {
  const Voxel low = BlockKey::low_of(key);
  const std::uint64_t slices = row_in(range[2], low[2]);
  const std::uint64_t rows = row_in(range[1], low[1]);
  const std::uint64_t along_x = row_in(range[0], low[0]);
  std::uint64_t slice = 0;
  for (unsigned row = 0; row < 8; ++row) {
    if ((rows >> row & 1U) != 0) slice |= along_x << (8 * row);
  }
  Bits bits{};
  for (std::size_t z = 0; z < bits.size(); ++z) bits[z] = (slices >> z & 1U) != 0 ? slice : 0;
  return bits;
}

void VoxelSet::add(std::uint64_t key, const Bits& bits) {
  Bits& block = blocks_.at(key);
  for (std::size_t z = 0; z < 8; ++z) {
    size_ += static_cast<std::uint64_t>(std::popcount(bits[z] & ~block[z]));
    block[z] |= bits[z];
  }
}

bool VoxelSet::insert(const Voxel& voxel) { return VoxelMarker(*this).insert(voxel); }

std::uint64_t& VoxelMarker::word_of(const Voxel& voxel) {
  const std::uint64_t key = BlockKey::of(voxel);
  if (bits_ == nullptr || key != key_) {
    bits_ = &set_.blocks_.at(key);
    key_ = key;
  }
  return (*bits_)[static_cast<std::size_t>(voxel[2] & 7)];
}

bool VoxelMarker::insert(const Voxel& voxel) {
  std::uint64_t& word = word_of(voxel);
  const bool is_new = (word & bit_of(voxel)) == 0;
  word |= bit_of(voxel);
  set_.size_ += is_new ? 1 : 0;
  return is_new;
}

void VoxelSet::insert(const VoxelCube& cube) {
  const auto end = [&](std::size_t axis) { return cube.min[axis] + cube.size; };
  if (cube.size < 8) {
    Voxel voxel{};
    for (voxel[2] = cube.min[2]; voxel[2] < end(2); ++voxel[2]) {
      for (voxel[1] = cube.min[1]; voxel[1] < end(1); ++voxel[1]) {
        for (voxel[0] = cube.min[0]; voxel[0] < end(0); ++voxel[0]) insert(voxel);
      }
    }
    return;
  }
  Bits full{};
  full.fill(~std::uint64_t{0});
  Voxel low{};
  for (low[2] = cube.min[2]; low[2] < end(2); low[2] += 8) {
    for (low[1] = cube.min[1]; low[1] < end(1); low[1] += 8) {
      for (low[0] = cube.min[0]; low[0] < end(0); low[0] += 8) add(BlockKey::of(low), full);
    }
  }
}

bool VoxelSet::contains(const Voxel& voxel) const {
  for (const std::int32_t coordinate : voxel) {
    if (coordinate < -kMostVoxels || coordinate >= kMostVoxels) return false;
  }
  const Bits* const bits = blocks_.find(BlockKey::of(voxel));
  if (bits == nullptr) return false;
  const std::uint64_t word = (*bits)[static_cast<std::size_t>(voxel[2] & 7)];
  return (word >> ((voxel[1] & 7) * 8 + (voxel[0] & 7)) & 1U) != 0;
}

void VoxelSet::extend(Range& range, std::uint64_t key, const Bits& bits) {
  std::array<unsigned, 3> along{};  // which of the eight places on each axis have a voxel
  std::uint64_t slice = 0;
  for (unsigned z = 0; z < bits.size(); ++z) {
    slice |= bits[z];
    if (bits[z] != 0) along[2] |= 1U << z;
  }
  if (slice == 0) return;
  for (unsigned y = 0; y < 8; ++y) {
    const auto row = static_cast<unsigned>(slice >> (8 * y) & 0xFFU);
    along[0] |= row;
    if (row != 0) along[1] |= 1U << y;
  }
  const Voxel low = BlockKey::low_of(key);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    VoxelRange& on_axis = range[axis];
    on_axis.first = std::min(on_axis.first, low[axis] + std::countr_zero(along[axis]));
    on_axis.last = std::max(on_axis.last,
                            low[axis] + static_cast<std::int32_t>(std::bit_width(along[axis])) - 1);
  }
}

VoxelSet::Range VoxelSet::bounds() const {
  Range range = kNoVoxels;
  blocks_.for_each([&](std::uint64_t key, const Bits& bits) { extend(range, key, bits); });
  return range;
}

}  // namespace camway::scene
