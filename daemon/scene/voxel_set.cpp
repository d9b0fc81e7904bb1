// SPDX-License-Identifier: MIT
#include "daemon/scene/voxel_set.h"

#include <algorithm>

namespace camway::scene {
namespace {

/// Of a coordinate of a block in a key; one more than blocks need, for their neighbours.
constexpr unsigned kAxisBits = 19;
constexpr std::int32_t kFirstBlock = -(std::int32_t{1} << (kAxisBits - 1));
constexpr std::uint64_t kAxisMask = (std::uint64_t{1} << kAxisBits) - 1;

constexpr std::uint64_t kLowestX = 0x0101'0101'0101'0101;
constexpr std::uint64_t kHighestX = 0x8080'8080'8080'8080;

/// Which bits of a row of eight, beginning with voxel `low`, lie in `range`.
std::uint64_t bits_in(const VoxelRange& range, std::int32_t low) {
  std::uint64_t bits = 0;
  for (std::int32_t i = 0; i < 8; ++i) {
    if (low + i >= range.first && low + i <= range.last) bits |= std::uint64_t{1} << i;
  }
  return bits;
}

/// Multiples of 8 from the block of `range.first` to that of `range.last`.
VoxelRange blocks_of(const VoxelRange& range) { return {range.first & ~7, range.last & ~7}; }

}  // namespace

std::uint64_t VoxelSet::key_of(const Voxel& voxel) {
  std::uint64_t key = 0;
  for (std::size_t axis = 3; axis-- > 0;) {
    key = (key << kAxisBits) | static_cast<std::uint64_t>((voxel[axis] >> 3) - kFirstBlock);
  }
  return key;
}

Voxel VoxelSet::low_of(std::uint64_t key) {
  Voxel low{};
  for (std::int32_t& coordinate : low) {
    coordinate = (static_cast<std::int32_t>(key & kAxisMask) + kFirstBlock) * 8;
    key >>= kAxisBits;
  }
  return low;
}

std::vector<std::uint64_t> VoxelSet::sorted_keys() const {
  std::vector<std::uint64_t> keys;
  keys.reserve(blocks_.size());
  for (const auto& [key, bits] : blocks_) keys.push_back(key);
  std::ranges::sort(keys);
  return keys;
}

const VoxelSet::Bits* VoxelSet::find(std::uint64_t key) const {
  const auto found = blocks_.find(key);
  return found == blocks_.end() ? nullptr : &found->second;
}

void VoxelSet::add(std::uint64_t key, const Bits& bits) {
  Bits& block = blocks_[key];
  for (std::size_t z = 0; z < 8; ++z) {
    size_ += static_cast<std::uint64_t>(std::popcount(bits[z] & ~block[z]));
    block[z] |= bits[z];
  }
}

bool VoxelSet::insert(const Voxel& voxel) { return VoxelMarker(*this).insert(voxel); }

std::uint64_t& VoxelMarker::word_of(const Voxel& voxel) {
  const std::uint64_t key = VoxelSet::key_of(voxel);
  if (bits_ == nullptr || key != key_) {
    bits_ = &set_.blocks_[key];  // stays where it is when others come
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
      for (low[0] = cube.min[0]; low[0] < end(0); low[0] += 8) add(key_of(low), full);
    }
  }
}

bool VoxelSet::contains(const Voxel& voxel) const {
  for (const std::int32_t coordinate : voxel) {
    if (coordinate < -kMostVoxels || coordinate >= kMostVoxels) return false;
  }
  const Bits* const bits = find(key_of(voxel));
  if (bits == nullptr) return false;
  const std::uint64_t word = (*bits)[static_cast<std::size_t>(voxel[2] & 7)];
  return (word >> ((voxel[1] & 7) * 8 + (voxel[0] & 7)) & 1U) != 0;
}

std::uint64_t VoxelSet::memory_bytes() const {
  constexpr std::uint64_t kOfATableEntry = 4 * sizeof(void*);
  return blocks_.size() * (sizeof(Bits) + kOfATableEntry);
}

VoxelSet::Range VoxelSet::bounds() const {
  Range range;
  range.fill({kMostVoxels, -kMostVoxels});
  for_each([&](const Voxel& voxel) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      range[axis].first = std::min(range[axis].first, voxel[axis]);
      range[axis].last = std::max(range[axis].last, voxel[axis]);
    }
  });
  return range;
}

VoxelSet VoxelSet::complement_in(const Range& range) const {
  VoxelSet result;
  const VoxelRange along_x = blocks_of(range[0]);
  const VoxelRange along_y = blocks_of(range[1]);
  const VoxelRange along_z = blocks_of(range[2]);
  for (std::int32_t z = along_z.first; z <= along_z.last; z += 8) {
    const std::uint64_t slices = bits_in(range[2], z);
    for (std::int32_t y = along_y.first; y <= along_y.last; y += 8) {
      const std::uint64_t rows = bits_in(range[1], y);
      for (std::int32_t x = along_x.first; x <= along_x.last; x += 8) {
        std::uint64_t slice = 0;
        for (unsigned row = 0; row < 8; ++row) {
          if ((rows >> row & 1U) != 0) slice |= bits_in(range[0], x) << (8 * row);
        }
        const std::uint64_t key = key_of({x, y, z});
        const Bits* const taken = find(key);
        Bits bits{};
        for (std::size_t k = 0; k < 8; ++k) {
          if ((slices >> k & 1U) != 0) bits[k] = slice & (taken != nullptr ? ~(*taken)[k] : ~0ULL);
        }
        if (bits != Bits{}) result.add(key, bits);
      }
    }
  }
  return result;
}

/// Makes the mesh of a skin, block by block.
class VoxelSkin {
 public:
  VoxelSkin(const VoxelSet& set, double voxel_m, std::size_t max_triangles)
      : set_(set), voxel_m_(voxel_m), max_triangles_(max_triangles) {}

  std::optional<Mesh> build() {
    for (const std::uint64_t key : set_.sorted_keys()) {
      const Voxel low = VoxelSet::low_of(key);
      const Bits& bits = *set_.find(key);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const std::int32_t side : {0, 1}) {
          Voxel beside = low;
          beside[axis] += side == 0 ? -8 : 8;
          const Bits* const found = set_.find(VoxelSet::key_of(beside));
          add_faces(low, axis, side, exposed(bits, found != nullptr ? *found : Bits{}, axis, side));
        }
      }
      if (mesh_.triangles.size() > max_triangles_) return std::nullopt;
    }
    mesh_.objects.push_back({"", 0, static_cast<std::uint32_t>(mesh_.triangles.size())});
    return std::move(mesh_);
  }

 private:
  using Bits = VoxelSet::Bits;

  /// The voxels of a block that have none beside them on that side; `beside` is the next block.
  static Bits exposed(const Bits& bits, const Bits& beside, std::size_t axis, std::int32_t side) {
    Bits neighbours{};
    for (std::size_t z = 0; z < 8; ++z) {
      if (axis == 0 && side == 1) {
        neighbours[z] = (bits[z] >> 1 & ~kHighestX) | (beside[z] & kLowestX) << 7;
      } else if (axis == 0) {
        neighbours[z] = (bits[z] << 1 & ~kLowestX) | (beside[z] & kHighestX) >> 7;
      } else if (axis == 1) {
        neighbours[z] = side == 1 ? bits[z] >> 8 | beside[z] << 56 : bits[z] << 8 | beside[z] >> 56;
      } else if (side == 1) {
        neighbours[z] = z < 7 ? bits[z + 1] : beside[0];
      } else {
        neighbours[z] = z > 0 ? bits[z - 1] : beside[7];
      }
    }
    Bits result{};
    for (std::size_t z = 0; z < 8; ++z) result[z] = bits[z] & ~neighbours[z];
    return result;
  }

  void add_faces(const Voxel& low, std::size_t axis, std::int32_t side, const Bits& bits) {
    for (std::int32_t z = 0; z < 8; ++z) {
      for (std::uint64_t left = bits[static_cast<std::size_t>(z)]; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        add_face({low[0] + bit % 8, low[1] + bit / 8, low[2] + z}, axis, side);
      }
    }
  }

  void add_face(const Voxel& voxel, std::size_t axis, std::int32_t side) {
    std::array<std::uint32_t, 4> corner{};
    for (std::size_t i = 0; i < 4; ++i) {
      Voxel at = voxel;
      at[axis] += side;
      at[(axis + 1) % 3] += static_cast<std::int32_t>(i & 1U);
      at[(axis + 2) % 3] += static_cast<std::int32_t>(i >> 1U);
      corner[i] = vertex(at);
    }
    if (side == 0) std::swap(corner[1], corner[2]);
    mesh_.triangles.push_back({corner[0], corner[1], corner[3]});
    mesh_.triangles.push_back({corner[0], corner[3], corner[2]});
  }

  std::uint32_t vertex(const Voxel& at) {
    constexpr unsigned kCornerBits = 21;  // one corner more than voxels
    std::uint64_t key = 0;
    for (const std::int32_t coordinate : at) {
      key = key << kCornerBits | static_cast<std::uint64_t>(coordinate + VoxelSet::kMostVoxels);
    }
    const auto [found, is_new] =
        vertices_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(geometry::Vec3(at[0], at[1], at[2]) * voxel_m_);
    return found->second;
  }

  const VoxelSet& set_;
  double voxel_m_;
  std::size_t max_triangles_;
  Mesh mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
};

std::optional<Mesh> skin_of(const VoxelSet& set, double voxel_m, std::size_t max_triangles) {
  return VoxelSkin(set, voxel_m, max_triangles).build();
}

}  // namespace camway::scene
