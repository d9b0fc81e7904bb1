// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/voxels/voxel_set.h"

namespace camway::scene {

/// The mesh of the faces between voxels of `set`, of edge `voxel_m`, and all others. Each is two
/// triangles turned outwards that share vertices with their neighbours: a closed surface up to the
/// rounding of i * voxel_m. Returns nothing if it would have more than `max_triangles`.
std::optional<Mesh> skin_of(const VoxelSet& set, double voxel_m, std::size_t max_triangles);

/// The same faces, with a mesh of its own for each brick of 16 x 16 x 16 voxels that has any.
/// Bricks share no vertices, but have equal coordinates where they meet. So a change of the set
/// changes few bricks, and the others are shared. The bricks and their order follow from the set.
/// A value type. Const calls are thread-safe.
class VoxelSkin {
 public:
  /// A brick has 2^kBrickLevels blocks along an edge. Measured: larger bricks answer queries no
  /// faster, and smaller ones enlarge the upper tree of the scene's index.
  static constexpr unsigned kBrickLevels = 1;

  /// The faces of `set`. Returns nothing if there are more than `max_triangles` triangles. Works on
  /// all processors; the result does not depend on their number.
  static std::optional<VoxelSkin> of(const VoxelSet& set, double voxel_m,
                                     std::size_t max_triangles);

  /// Returns what `of` returns for `after`, but shares all equal bricks with this object. The cost
  /// depends on the difference, with a little for each brick. Requires that this object was made
  /// from `before` with the same `voxel_m`.
  [[nodiscard]] std::optional<VoxelSkin> updated(const VoxelSet& before, const VoxelSet& after,
                                                 double voxel_m, std::size_t max_triangles) const;

  /// The meshes of the bricks, none empty, by the key of the first block (`BlockKey`), increasing.
  [[nodiscard]] const std::vector<MeshPart>& parts() const { return parts_; }

 private:
  std::vector<MeshPart> parts_;
};

}  // namespace camway::scene
