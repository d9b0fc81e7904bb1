// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace camway::scene {

/// Which of the limits that a caller sets something would have passed. An error says so in words,
/// this for those who have names of their own for the limits.
enum class Limit : std::uint8_t {
  kNone,            ///< it was something else
  kScenes,          ///< `SceneStoreLimits::scenes`
  kObjects,         ///< `SceneStoreLimits::objects`
  kTriangles,       ///< `SceneStoreLimits::triangles`
  kOccupancyBytes,  ///< `SceneStoreLimits::occupancy_bytes`
  kMirrorVoxels,    ///< `ObjectOptions::mirror_voxels`
  kMapVoxels,       ///< `VoxelMapLimits::voxels`
  kMapTriangles,    ///< `VoxelMapLimits::triangles`
  kScanVoxels,      ///< of `scanned`
};

}  // namespace camway::scene
