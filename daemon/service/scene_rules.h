// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/scene/map_scan.h"
#include "daemon/service/scene_roots.h"

namespace camway::service {

/// What clients may do with files, and how much a change may cost.
struct SceneRules {
  SceneRoots roots;  ///< of files that clients may name; `scenes.roots`
  /// Whether clients may have maps written below the roots, over a file of the same name.
  bool write_maps = false;
  double scan_voxels = scene::kMostScanVoxels;  ///< that the rays of a scan may pass
};

}  // namespace camway::service
