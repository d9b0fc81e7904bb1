// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/import/record/import_options.h"
#include "daemon/scene/import/record/record_layout.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

/// The occupancy map of a record, or why there is none.
struct RecordMap {
  std::shared_ptr<const VoxelMap> map;  ///< with faces; null exactly if there is a `refusal`
  /// Origin of the frame of the map in the frame of the object, which has equal axes.
  geometry::Vec3 origin_m = geometry::Vec3::Zero();
  std::string refusal;
  Limit limit = Limit::kNone;      ///< limit that the refusal is about
  std::vector<std::string> notes;  ///< sentences about what was assumed and left out
};

/// Makes the map of a record with cubes. Checks each cube. `scale`: metres per file unit. Where the
/// voxels of the file begin at a multiple of their edge, they are numbered from the origin.
RecordMap map_of_cubes(const import_record::Record& record, const ImportOptions& options,
                       double scale);

/// Makes the map of a cloud of points: each point with finite coordinates is inside an occupied
/// voxel or on its boundary, and each occupied voxel holds a point (`voxels_of_cloud`). Nothing is
/// known of other space. Without `options.voxel_m`, voxels have the size `usual_voxel_m`, doubled
/// until the map is within its limits.
RecordMap map_of_cloud(const import_record::Record& record, const ImportOptions& options,
                       double scale);

}  // namespace camway::scene
