// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "daemon/geometry/types.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

/// The points that a sensor saw from one place, in the frame of the map.
struct Scan {
  geometry::Vec3 origin_O = geometry::Vec3::Zero();
  std::span<const geometry::Vec3> points_O;
};

/// Default limit of the voxels that all rays of a scan pass through, each counted once per ray.
inline constexpr double kMostScanVoxels = 5e7;

/// The map after a scan, by OctoMap's sensor model (Hornung et al. 2013, `insertPointCloud`), in
/// single precision. The voxel of a point is a hit; voxels between the sensor and a point are
/// misses; a voxel that is both is a hit. A ray longer than the sensor's range makes misses within
/// the range only. Voxels of blocks that were never scanned begin with the clamping probability of
/// their state if it is known, else with even odds. Both maps share what the scan does not change.
/// The cost depends on the voxels that rays pass and on the faces that change (`VoxelSkin`).
///
/// Fails if a point or the origin is not finite or beyond OctoMap's keys, if a ray is too long for
/// OctoMap, or if the rays pass through more than `most_voxels` voxels.
VoxelMapResult scanned(const VoxelMap& before, const Scan& scan,
                       double most_voxels = kMostScanVoxels);

}  // namespace camway::scene
