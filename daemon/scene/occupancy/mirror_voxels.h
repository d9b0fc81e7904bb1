// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>

#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/voxels/voxel_grid.h"
#include "daemon/scene/voxels/voxel_map.h"
#include "daemon/scene/voxels/voxel_set.h"

namespace camway::scene {

/// What an occupancy mirror is made of, and when to give it up.
struct MirrorTask {
  std::span<const Mesh* const> meshes;
  /// Of which the meshes are the faces, if they are those of a solid.
  const std::optional<PlacedVoxelMap>& solid;
  VoxelGrid grid;
  std::uint64_t max_voxels;
  std::stop_token stop;
};

struct MirrorVoxels {
  std::optional<VoxelSet> voxels;  ///< nothing if there are too many, or a stop was asked for
  bool is_called_off = false;      ///< it was the stop
};

/// A number of voxels that no mirror of this has less than: those of its largest triangle, as no
/// plane meets more of a cube than the rectangle through two opposite edges, and those that take
/// the room of its solid. Costs a look at each triangle.
double least_voxels(const MirrorTask& task);

/// The voxels that a triangle touches, and those with their middle in the solid: what no face
/// touches is inside with all of it. Looks at no more voxels than a constant times those and the
/// voxels of the solid, and at none of what `least_voxels` says is too much; ends within
/// milliseconds after a stop. Preconditions: the vertices are finite and within the grid's keys.
MirrorVoxels mirror_voxels(const MirrorTask& task);

}  // namespace camway::scene
