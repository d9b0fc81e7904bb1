// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/voxels/voxel_set.h"

namespace camway::scene {

/// Returns the mesh of all faces that separate a voxel of `set` from a voxel outside it. Voxels are
/// cubes with the edge `voxel_m`. Each face is two triangles that point outwards and share vertices
/// with their neighbours. So the mesh is a closed surface, up to the rounding of i * voxel_m.
/// Returns nothing if it would have more than `max_triangles`.
std::optional<Mesh> faces_of(const VoxelSet& set, double voxel_m, std::size_t max_triangles);

/// The faces of a set of voxels, with a mesh of its own for each brick of 16 x 16 x 16 voxels that
/// has a face. Bricks share no vertices, but have equal coordinates where they meet. So a change of
/// the set changes few bricks, and the others are shared. The bricks and their order follow from
/// the set. A value type. Const calls are thread-safe.
class VoxelFaces {
 public:
  /// A brick has 2^kBrickLevels blocks along an edge. Measured: larger bricks answer queries no
  /// faster, and smaller ones enlarge the upper tree of the scene's index.
  static constexpr unsigned kBrickLevels = 1;

  /// Returns the faces of `set`, or nothing if there are more than `max_triangles` triangles. Works
  /// on all processors; the result does not depend on their number.
  static std::optional<VoxelFaces> of(const VoxelSet& set, double voxel_m,
                                      std::size_t max_triangles);

  /// Returns what `of` returns for `after`, but shares all equal bricks with this object. The cost
  /// depends on the difference, with a little for each brick. Requires that this object was made
  /// from `before` with the same `voxel_m`.
  [[nodiscard]] std::optional<VoxelFaces> updated(const VoxelSet& before, const VoxelSet& after,
                                                  double voxel_m, std::size_t max_triangles) const;

  /// The meshes of the bricks, none empty, by the key of the first block (`BlockKey`), increasing.
  [[nodiscard]] const std::vector<MeshPart>& parts() const { return parts_; }

 private:
  std::vector<MeshPart> parts_;
};

}  // namespace camway::scene
