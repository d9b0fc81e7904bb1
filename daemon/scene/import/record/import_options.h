// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

/// How axes are turned; only on request.
enum class UpAxis {
  kAsInFile,  ///< keeps coordinates of the file, node transforms applied
  kZToY,      ///< the file has Z up, the scene shall have Y up: (x, y, z) -> (x, z, -y)
  kYToZ,      ///< the file has Y up, the scene shall have Z up: (x, y, z) -> (x, -z, y)
};

/// How to read a file, and the limits of the import process.
struct ImportOptions {
  /// Metres per file unit, or a factor beside the unit that the file states. [Limit: 0 < value]
  double scale = 1.0;
  UpAxis up = UpAxis::kAsInFile;
  UnknownSpace unknown = UnknownSpace::kFree;  ///< for an occupancy map
  /// Edge of the voxels of a cloud of points, in metres; nothing: chosen from the cloud.
  std::optional<double> voxel_m = {};
  VoxelMapLimits map_limits = {};  ///< for an occupancy map and a cloud of points
  std::size_t memory_limit_bytes = std::size_t{4} << 30;  ///< address space of the import process
  double time_limit_s = 60.0;                             ///< wall clock of the import process
};

}  // namespace camway::scene
