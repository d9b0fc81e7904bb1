// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "daemon/scene/import/import.h"
#include "daemon/scene/import/record/import_options.h"
#include "daemon/scene/import/record/import_report.h"
#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

/// A mesh, or the reason why there is none. `report` covers the import as far as it got.
struct ImportResult {
  std::optional<Mesh> mesh;
  std::shared_ptr<const VoxelMap> map;  ///< map whose faces the mesh is; null for a mesh
  /// Origin of the frame of the map, and of its mesh, in the frame of the scene.
  geometry::Vec3 map_origin_m = geometry::Vec3::Zero();
  ImportReport report;
  std::string error;           ///< names the file; empty exactly when `mesh` holds a value
  Limit limit = Limit::kNone;  ///< limit that the error is about
};

/// Reads a scene file in a child process with limits of memory and time, since a hostile file of a
/// few bytes can cost gigabytes or crash the reader: OBJ, OFF, PLY, STL, UniGrafix and Bezier
/// patches with our own readers (`readers/mesh_reader.h`, `unigrafix/unigrafix_reader.h`,
/// `surfaces/bezier_patches.h`), clouds of points and voxels of Gaussian splats, too, as occupancy
/// maps (`points/point_reader.h`, `child/splat_voxels.h`), occupancy maps (.bt and .ot) with
/// OctoMap, Open Inventor and VRML with Coin, STEP and IGES with Open CASCADE, other formats with
/// assimp. Checks the result again (indices, finiteness, counts). Never throws for a bad file.
/// Fails within milliseconds after a stop is requested. Thread-safe.
ImportResult import_mesh(const std::filesystem::path& file, const ImportOptions& options,
                         const std::stop_token& stop = {});

}  // namespace camway::scene
