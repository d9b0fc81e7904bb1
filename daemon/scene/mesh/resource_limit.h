// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace camway::scene {

/// The configured limit that an operation would have exceeded. The error text names it for people;
/// this is for callers that have their own names for the limits.
enum class Limit : std::uint8_t {
  kNone,            ///< the error is about something else
  kScenes,          ///< `SceneStoreLimits::scenes`
  kObjects,         ///< `SceneStoreLimits::objects`
  kTriangles,       ///< `SceneStoreLimits::triangles`
  kOccupancyBytes,  ///< `SceneStoreLimits::occupancy_bytes`
  kMirrorVoxels,    ///< `ObjectOptions::mirror_voxels`
  kMapVoxels,       ///< `VoxelMapLimits::voxels`
  kMapTriangles,    ///< `VoxelMapLimits::triangles`
  kScanVoxels,      ///< `most_voxels` of `scanned`
};

}  // namespace camway::scene
