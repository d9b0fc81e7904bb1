// SPDX-License-Identifier: MIT
#include "daemon/scene/voxels/voxel_faces.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

#include "daemon/base/parallel_chunks.h"

namespace camway::scene {
namespace {

using Bits = VoxelSet::Bits;

constexpr std::uint64_t kLowestX = 0x0101'0101'0101'0101;
constexpr std::uint64_t kHighestX = 0x8080'8080'8080'8080;

constexpr std::int32_t kBrickVoxels = BlockKey::kBlockSize << VoxelFaces::kBrickLevels;

std::uint64_t brick_of(std::uint64_t block) {
  return BlockKey::first_of_cube(block, VoxelFaces::kBrickLevels);
}

/// The block beside the block that begins at `low`.
std::uint64_t beside(const Voxel& low, std::size_t axis, int side) {
  Voxel next = low;
  next[axis] += side == 0 ? -BlockKey::kBlockSize : BlockKey::kBlockSize;
  return BlockKey::of(next);
}

/// The voxels of a block in its outermost layer on one side.
Bits layer(const Bits& bits, std::size_t axis, int side) {
  constexpr std::uint64_t kRow = 0xFF;
  Bits result{};
  if (axis == 2) {
    const std::size_t z = side == 0 ? 0 : 7;
    result[z] = bits[z];
    return result;
  }
  const std::uint64_t mask =
      axis == 0 ? (side == 0 ? kLowestX : kHighestX) : (side == 0 ? kRow : kRow << 56);
  for (std::size_t z = 0; z < bits.size(); ++z) result[z] = bits[z] & mask;
  return result;
}

/// The voxels of a block without a neighbour on that side; `next` is the neighbouring block.
Bits exposed(const Bits& bits, const Bits& next, std::size_t axis, int side) {
  Bits neighbours{};
  for (std::size_t z = 0; z < 8; ++z) {
    if (axis == 0 && side == 1) {
      neighbours[z] = (bits[z] >> 1 & ~kHighestX) | (next[z] & kLowestX) << 7;
    } else if (axis == 0) {
      neighbours[z] = (bits[z] << 1 & ~kLowestX) | (next[z] & kHighestX) >> 7;
    } else if (axis == 1) {
      neighbours[z] = side == 1 ? bits[z] >> 8 | next[z] << 56 : bits[z] << 8 | next[z] >> 56;
    } else if (side == 1) {
      neighbours[z] = z < 7 ? bits[z + 1] : next[0];
    } else {
      neighbours[z] = z > 0 ? bits[z - 1] : next[7];
    }
  }
  Bits result{};
  for (std::size_t z = 0; z < 8; ++z) result[z] = bits[z] & ~neighbours[z];
  return result;
}

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// The index of the vertex at each corner of voxels, for any corners.
class HashedCorners {
 public:
  std::uint32_t& at(const Voxel& corner) {
    constexpr unsigned kCornerBits = 21;  // one corner more than voxels
    std::uint64_t key = 0;
    for (const std::int32_t coordinate : corner) {
      key = key << kCornerBits | static_cast<std::uint64_t>(coordinate + VoxelSet::kMostVoxels);
    }
    return vertices_.try_emplace(key, kNoVertex).first->second;
  }

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
};

/// The same for the corners of one brick.
class BrickCorners {
 public:
  explicit BrickCorners(const Voxel& low) : low_(low) { vertices_.fill(kNoVertex); }

  std::uint32_t& at(const Voxel& corner) {
    std::size_t place = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
      place = place * kSide + static_cast<std::size_t>(corner[axis] - low_[axis]);
    }
    return vertices_[place];
  }

 private:
  static constexpr std::size_t kSide = kBrickVoxels + 1;

  Voxel low_;
  std::array<std::uint32_t, kSide * kSide * kSide> vertices_;
};

/// Makes the mesh of faces, block by block.
template <class Corners>
class FaceBuilder {
 public:
  FaceBuilder(const VoxelSet& set, double voxel_m, Corners corners)
      : set_(set), voxel_m_(voxel_m), corners_(std::move(corners)) {}

  void add_block(std::uint64_t key) {
    const Bits bits = set_.block(key);
    if (bits == Bits{}) return;
    const Voxel low = BlockKey::low_of(key);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        add_faces(low, axis, side, exposed(bits, set_.block(beside(low, axis, side)), axis, side));
      }
    }
  }

  [[nodiscard]] std::size_t triangles() const { return mesh_.triangles.size(); }

  Mesh take() {
    mesh_.objects.push_back({"", 0, static_cast<std::uint32_t>(mesh_.triangles.size())});
    return std::move(mesh_);
  }

 private:
  void add_faces(const Voxel& low, std::size_t axis, int side, const Bits& bits) {
    for (std::int32_t z = 0; z < 8; ++z) {
      for (std::uint64_t left = bits[static_cast<std::size_t>(z)]; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        add_face({low[0] + bit % 8, low[1] + bit / 8, low[2] + z}, axis, side);
      }
    }
  }

  void add_face(const Voxel& voxel, std::size_t axis, int side) {
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
    std::uint32_t& index = corners_.at(at);
    if (index == kNoVertex) {
      index = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(geometry::Vec3(at[0], at[1], at[2]) * voxel_m_);
    }
    return index;
  }

  const VoxelSet& set_;
  double voxel_m_;
  Corners corners_;
  Mesh mesh_;
};

Mesh mesh_of_brick(const VoxelSet& set, double voxel_m, std::uint64_t brick) {
  FaceBuilder builder(set, voxel_m, BrickCorners(BlockKey::low_of(brick)));
  constexpr unsigned kSide = 1U << VoxelFaces::kBrickLevels;
  for (unsigned z = 0; z < kSide; ++z) {
    for (unsigned y = 0; y < kSide; ++y) {
      for (unsigned x = 0; x < kSide; ++x) {
        builder.add_block(BlockKey::in_cube(brick, x | y << 3 | z << 6));
      }
    }
  }
  Mesh mesh = builder.take();
  mesh.vertices.shrink_to_fit();
  mesh.triangles.shrink_to_fit();
  return mesh;
}

/// The meshes of these bricks, in their order, without those that have no faces; nothing if they
/// have more than `max_triangles`.
std::optional<std::vector<MeshPart>> parts_of(const VoxelSet& set, double voxel_m,
                                              std::span<const std::uint64_t> bricks,
                                              std::size_t max_triangles) {
  std::vector<MeshPart> parts(bricks.size());
  std::atomic<std::size_t> triangles{0};
  base::for_each_chunk(base::chunk_threads(0), bricks.size(), [&](unsigned, std::size_t i) {
    if (triangles.load(std::memory_order_relaxed) > max_triangles) return;
    parts[i] = MeshPart::of(bricks[i], mesh_of_brick(set, voxel_m, bricks[i]));
    triangles += parts[i].mesh->triangles.size();
  });
  if (triangles > max_triangles) return std::nullopt;
  std::erase_if(parts, [](const MeshPart& part) { return part.mesh->triangles.empty(); });
  return parts;
}

/// The bricks in which a changed voxel may change a face.
std::set<std::uint64_t> bricks_touched(const VoxelSet& before, const VoxelSet& after) {
  std::set<std::uint64_t> bricks;
  after.for_each_difference(before, [&](std::uint64_t key, const Bits& old, const Bits& now) {
    bricks.insert(brick_of(key));
    Bits changed{};
    for (std::size_t z = 0; z < changed.size(); ++z) changed[z] = old[z] ^ now[z];
    const Voxel low = BlockKey::low_of(key);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        if (layer(changed, axis, side) != Bits{}) bricks.insert(brick_of(beside(low, axis, side)));
      }
    }
  });
  return bricks;
}

bool are_equal(const Mesh& a, const Mesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

}  // namespace

std::optional<Mesh> faces_of(const VoxelSet& set, double voxel_m, std::size_t max_triangles) {
  FaceBuilder builder(set, voxel_m, HashedCorners());
  for (const std::uint64_t key : set.sorted_keys()) {
    builder.add_block(key);
    if (builder.triangles() > max_triangles) return std::nullopt;
  }
  return builder.take();
}

std::optional<VoxelFaces> VoxelFaces::of(const VoxelSet& set, double voxel_m,
                                         std::size_t max_triangles) {
  std::vector<std::uint64_t> bricks = set.sorted_keys();
  for (std::uint64_t& key : bricks) key = brick_of(key);
  std::ranges::sort(bricks);
  // Not std::ranges::unique: Clang 14 cannot compile that of GCC 12's library.
  bricks.erase(std::unique(bricks.begin(), bricks.end()), bricks.end());
  std::optional<std::vector<MeshPart>> parts = parts_of(set, voxel_m, bricks, max_triangles);
  if (!parts) return std::nullopt;
  VoxelFaces made_faces;
  made_faces.parts_ = *std::move(parts);
  return made_faces;
}

std::optional<VoxelFaces> VoxelFaces::updated(const VoxelSet& before, const VoxelSet& after,
                                              double voxel_m, std::size_t max_triangles) const {
  const std::set<std::uint64_t> touched = bricks_touched(before, after);
  const std::vector<std::uint64_t> bricks(touched.begin(), touched.end());
  std::optional<std::vector<MeshPart>> made = parts_of(after, voxel_m, bricks, max_triangles);
  if (!made) return std::nullopt;
  VoxelFaces made_faces;
  made_faces.parts_.reserve(parts_.size() + made->size());
  std::size_t triangles = 0;
  auto fresh = made->begin();
  const auto take = [&](const MeshPart& part) {
    made_faces.parts_.push_back(part);
    triangles += part.mesh->triangles.size();
  };
  for (const MeshPart& old : parts_) {
    for (; fresh != made->end() && fresh->key < old.key; ++fresh) take(*fresh);
    const bool is_anew = fresh != made->end() && fresh->key == old.key;
    if (is_anew) take(are_equal(*fresh->mesh, *old.mesh) ? old : *fresh);
    if (!is_anew && !touched.contains(old.key)) take(old);
    if (is_anew) ++fresh;
  }
  for (; fresh != made->end(); ++fresh) take(*fresh);
  if (triangles > max_triangles) return std::nullopt;
  return made_faces;
}

}  // namespace camway::scene
