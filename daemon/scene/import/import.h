// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "daemon/scene/import/import.h"
#include "daemon/scene/import/record/import_options.h"
#include "daemon/scene/import/record/import_report.h"
#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

/// What the reader of a format does to units and axes before we see a coordinate, as a sentence for
/// the user; empty where coordinates are those of the file.
std::string_view importer_note(std::string_view format);

/// Either a mesh or a reason. `report` is filled as far as the import came.
struct ImportResult {
  std::optional<Mesh> mesh;
  std::shared_ptr<const VoxelMap> map;  ///< of which the mesh is the faces; null for a mesh
  ImportReport report;
  std::string error;           ///< names the file; empty exactly when `mesh` holds a value
  Limit limit = Limit::kNone;  ///< that the error is about
};

/// Reads OBJ, OFF, PLY and STL itself (`scene/import/readers/mesh_reader.h`), occupancy maps (.bt
/// and .ot) with OctoMap and any other format that assimp reads, in a child process with limits of
/// memory and time, since a hostile file of a few bytes can cost gigabytes or crash the reader;
/// then checks what came back again (indices, finiteness, counts). Never throws for a bad file. May
/// be called from any thread. A requested stop ends the import within milliseconds, and it fails.
ImportResult import_mesh(const std::filesystem::path& file, const ImportOptions& options,
                         const std::stop_token& stop = {});

}  // namespace camway::scene
