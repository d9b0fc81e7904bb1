// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "daemon/scene/import/record/import_options.h"
#include "daemon/scene/import/record/import_report.h"
#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

/// What the import process answered, checked as if an enemy had written it.
struct ImportRecordResult {
  std::optional<Mesh> mesh;  ///< may have no triangle left; nothing if the file was refused
  std::shared_ptr<const VoxelMap> map;  ///< of which the mesh is the faces; null if it is none
  std::string refusal;                  ///< why the reader refused the file, printable; else empty
  Limit limit = Limit::kNone;           ///< that the refusal is about
  bool broken = false;                  ///< the bytes are no record; nothing else is set
  double relative_rounding = 0.0;       ///< as in the record's header; never negative or NaN
  double absolute_rounding = 0.0;
};

/// Takes apart the record of `import_format.h`: no count is believed before the bytes are there,
/// every index and coordinate is checked, scale and axes are applied. Triangles that cannot be used
/// are left out and counted in `report`, which also gets the name of the format.
/// An occupancy map becomes the faces of its voxels.
///
/// Left out as degenerate is only what has no area at all, in exact arithmetic on the scaled
/// coordinates: however thin, anything with an area is an obstacle.
ImportRecordResult read_import_record(std::span<const std::byte> bytes,
                                      const ImportOptions& options, ImportReport& report);

}  // namespace camway::scene
