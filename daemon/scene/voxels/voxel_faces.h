// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/voxels/voxel_set.h"

namespace camway::scene {

/// The faces between the voxels of `set`, of edge `voxel_m`, and all others: of each two triangles,
/// turned outwards, that share vertices with their neighbours. A closed surface up to the rounding
/// of i * voxel_m. Nothing if there would be more than `max_triangles`.
std::optional<Mesh> skin_of(const VoxelSet& set, double voxel_m, std::size_t max_triangles);

/// The same faces in parts: a mesh for each brick of 16 x 16 x 16 voxels in which a voxel has one.
/// Parts share no vertices, but where they meet they have equal coordinates. So where a set
/// changes, few parts do; the others are shared. Which parts there are, what is in them and their
/// order follow from the set alone. A value type; const calls are safe from any thread.
class VoxelSkin {
 public:
  /// Blocks of a brick along an edge are 2^kBrickLevels. Measured: larger bricks answer queries no
  /// faster, and smaller ones make more of a scene's upper tree.
  static constexpr unsigned kBrickLevels = 1;

  /// Nothing if there are more than `max_triangles`. On all processors; the result does not depend
  /// on them.
  static std::optional<VoxelSkin> of(const VoxelSet& set, double voxel_m,
                                     std::size_t max_triangles);

  /// What `of` makes of `after`, sharing every part that is equal to one of this skin. Costs what
  /// differs, and a little for each part. Preconditions: this is that of `before`, with this edge.
  [[nodiscard]] std::optional<VoxelSkin> updated(const VoxelSet& before, const VoxelSet& after,
                                                 double voxel_m, std::size_t max_triangles) const;

  /// By the key of the first block of their bricks (`BlockKey`), increasing; none is empty.
  [[nodiscard]] const std::vector<MeshPart>& parts() const { return parts_; }

 private:
  std::vector<MeshPart> parts_;
};

}  // namespace camway::scene
