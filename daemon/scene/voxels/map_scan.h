// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "daemon/geometry/types.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

/// What a sensor saw from one place, in the frame of the map.
struct Scan {
  geometry::Vec3 origin_O = geometry::Vec3::Zero();
  std::span<const geometry::Vec3> points_O;
};

/// By default a scan whose rays pass through more voxels than this, each counted, is refused.
inline constexpr double kMostScanVoxels = 5e7;

/// The map after a scan, by OctoMap's own sensor model (Hornung et al. 2013, `insertPointCloud`):
/// what lies between the sensor and a point is a miss, the voxel of the point a hit, one of both a
/// hit; of a ray that is longer than the sensor's range only the range is a miss. It computes in
/// single precision. Voxels that were never scanned begin with the certainty of their state:
/// clamped, if they are known. The two maps share what the scan does not change; it costs what the
/// rays pass through, and what the faces take where they change (`VoxelSkin`).
///
/// Refused are points and origins that OctoMap's keys cannot hold, and what would take too long.
VoxelMapResult scanned(const VoxelMap& before, const Scan& scan,
                       double most_voxels = kMostScanVoxels);

}  // namespace camway::scene
