// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/occupancy/occupancy_map.h"
#include "daemon/scene/voxels/map_scan.h"
#include "daemon/service/scenes/scene_roots.h"

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

/// The key of the setting that a limit is, e.g. "scenes.map_voxels"; empty of none.
std::string_view setting_of(scene::Limit limit);

/// `error` with the setting that would have to be higher behind it, if one would.
std::string with_setting(std::string_view error, scene::Limit limit);

}  // namespace camway::service
