// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/mirror/object_mirror.h"
#include "daemon/scene/voxels/map_scan.h"
#include "daemon/service/scenes/scene_roots.h"

namespace camway::service {

/// Permissions of clients on files, and limits on the cost of a change.
struct SceneRules {
  SceneRoots roots;  ///< folders of the files that clients may name; `scenes.roots`
  /// Whether clients may write maps below the roots, over a file of the same name.
  bool write_maps = false;
  double scan_voxels = scene::kMostScanVoxels;  ///< most voxels that the rays of a scan may pass
  scene::VoxelMapLimits maps;                   ///< `scenes.map_voxels` and `scenes.map_triangles`
  /// Largest number of voxels of the mirror of an object; `scenes.mirror_voxels`.
  std::uint64_t mirror_voxels = scene::ObjectMirror::kUsualMostVoxels;
};

/// Returns the key of the setting of a limit, e.g. "scenes.map_voxels"; empty for kNone.
std::string_view setting_of(scene::Limit limit);

/// Returns `error`, followed by the setting that would have to be higher, if there is one.
std::string with_setting(std::string_view error, scene::Limit limit);

}  // namespace camway::service
