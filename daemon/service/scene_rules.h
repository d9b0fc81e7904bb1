// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "daemon/scene/map_scan.h"
#include "daemon/scene/occupancy_map.h"
#include "daemon/service/scene_roots.h"

namespace camway::service {

/// What clients may do with files, and how much a change may cost.
struct SceneRules {
  SceneRoots roots;  ///< of files that clients may name; `scenes.roots`
  /// Whether clients may have maps written below the roots, over a file of the same name.
  bool write_maps = false;
  double scan_voxels = scene::kMostScanVoxels;  ///< that the rays of a scan may pass
  scene::VoxelMapLimits maps;                   ///< `scenes.map_voxels` and `scenes.map_triangles`
  /// Of the mirror of an object; `scenes.mirror_voxels`.
  std::uint64_t mirror_voxels = scene::OccupancyMap::kUsualMostVoxels;
};

}  // namespace camway::service
