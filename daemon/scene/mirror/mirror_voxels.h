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

/// The input of an occupancy mirror, and its limits.
struct MirrorTask {
  std::span<const Mesh* const> meshes;
  /// The solid whose faces the meshes are, if they are those of an occupancy map.
  const std::optional<PlacedVoxelMap>& solid;
  VoxelGrid grid;
  std::uint64_t max_voxels;
  std::stop_token stop;
};

struct MirrorVoxels {
  std::optional<VoxelSet> voxels;  ///< nothing if there are too many, or a stop was requested
  bool is_cancelled = false;       ///< whether the stop was the reason
};

/// A lower bound of the number of voxels of the mirror, at the cost of one pass over the triangles.
/// It is the larger of two: the voxels of the largest triangle, as no plane meets more of a cube
/// than the rectangle through two opposite edges; and those of the volume of the solid.
double least_voxels(const MirrorTask& task);

/// Computes the voxels that a triangle touches and those whose centre is inside the solid (a voxel
/// that no face touches is wholly inside or outside). Looks at no more voxels than a constant times
/// these and the voxels of the solid, and at none if `least_voxels` exceeds the limit. Ends within
/// milliseconds after a stop is requested. Requires finite vertices within the grid's keys.
MirrorVoxels mirror_voxels(const MirrorTask& task);

}  // namespace camway::scene
