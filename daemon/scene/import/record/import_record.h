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

/// The answer of the import process, which is checked like any untrusted input.
struct ImportRecordResult {
  std::optional<Mesh> mesh;  ///< may have no triangle left; nothing if the file was refused
  std::shared_ptr<const VoxelMap> map;  ///< map whose faces the mesh is; null if there is none
  /// Origin of the frame of the map, and of its mesh, in the frame of the scene.
  geometry::Vec3 map_origin_m = geometry::Vec3::Zero();
  std::string refusal;             ///< the reason of the refusal, in printable ASCII; else empty
  Limit limit = Limit::kNone;      ///< limit that the refusal is about
  bool broken = false;             ///< whether the bytes are no record; then nothing else is set
  double relative_rounding = 0.0;  ///< as in the record's header; never negative or NaN
  double absolute_rounding = 0.0;
  double surface_error = 0.0;
};

/// The answer of the import process about the cameras of a file.
struct CameraRecordResult {
  std::string cameras;  ///< text of `camera_import.h`; empty if the file has none
  double unit_m = 1.0;  ///< metres per file unit
  std::string refusal;  ///< the reason of the refusal, in printable ASCII; else empty
  bool broken = false;  ///< whether the bytes are no record; then nothing else is set
};
/// Parses a record as `read_import_record` does.
CameraRecordResult read_camera_record(std::span<const std::byte> bytes);

/// Parses the record of `record_layout.h`. Uses a count only after checking that the record has its
/// bytes. Checks every index and coordinate, and applies scale and axes. Leaves out unusable
/// triangles and counts them in `report`, whose format it sets, too. The mesh of an occupancy map
/// consists of the faces of its voxels. A cloud of points becomes an occupancy map
/// (`map_of_cloud`).
///
/// Degenerate triangles are left out only if they have no area at all, in exact arithmetic on the
/// scaled coordinates: any triangle with an area, however thin, is an obstacle.
ImportRecordResult read_import_record(std::span<const std::byte> bytes,
                                      const ImportOptions& options, ImportReport& report);

}  // namespace camway::scene
