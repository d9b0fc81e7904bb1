// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "daemon/base/result.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/voxels/voxel_set.h"

namespace camway::scene {

/// The voxels that hold a cloud's points.
struct CloudVoxels {
  VoxelSet voxels;
  /// The lowest corner of voxel (0, 0, 0). 0 on each axis where the voxels have keys of OctoMap
  /// then; else a multiple of the voxel near the middle of the points.
  geometry::Vec3 origin_m = geometry::Vec3::Zero();
};

/// Puts each point into a voxel. With the faces of voxel i at fl(fl(i * voxel_m) + origin_m), as a
/// placed map has them, each point is inside its voxel or on its boundary: the voxel is corrected
/// until the rounded faces enclose the point. Fails, with what to do, if the points are too far
/// apart for OctoMap's keys, or too far away for doubles to tell neighbouring faces apart.
/// Requires finite points and a `voxel_m` that is a `VoxelGrid::valid_resolution`.
base::Result<CloudVoxels> voxels_of_cloud(std::span<const geometry::Vec3> points_m, double voxel_m);

/// Returns the size of voxels that suits a cloud: twice the median of the distances from a point to
/// the nearest other one, of a sample, rounded up to two digits, and no less than
/// `voxels_of_cloud` accepts. So voxels of a surface that was scanned evenly touch each other.
/// Depends on the set of points, not on their order. Requires finite points.
double usual_voxel_m(std::span<const geometry::Vec3> points_m);

}  // namespace camway::scene
