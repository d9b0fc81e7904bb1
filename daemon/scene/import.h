// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "daemon/scene/limit.h"
#include "daemon/scene/mesh.h"
#include "daemon/scene/voxel_map.h"

namespace camway::scene {

/// Axes are turned only when asked for.
enum class UpAxis {
  kAsInFile,  ///< coordinates of the file, node transforms applied
  kZToY,      ///< the file has Z up, the scene shall have Y up: (x, y, z) -> (x, z, -y)
  kYToZ,      ///< the file has Y up, the scene shall have Z up: (x, y, z) -> (x, -z, y)
};

/// How to read a file, and how much it may cost.
struct ImportOptions {
  double scale = 1.0;  ///< file units to metres; multiplies every coordinate [Limit: 0 < value]
  UpAxis up = UpAxis::kAsInFile;
  UnknownSpace unknown = UnknownSpace::kFree;             ///< of an occupancy map
  VoxelMapLimits map_limits = {};                         ///< of an occupancy map
  std::size_t memory_limit_bytes = std::size_t{4} << 30;  ///< address space of the import process
  double time_limit_s = 60.0;                             ///< wall clock of the import process
};

/// What was read and what was assumed, so that a wrong unit or axis is seen at once.
struct ImportReport {
  std::string format;  ///< in the words of our reader or of assimp's
  double scale = 1.0;
  UpAxis up = UpAxis::kAsInFile;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t objects = 0;
  geometry::Box bounds_m;
  std::uint64_t degenerate_triangles = 0;  ///< of zero area; kept out of the scene
  std::uint64_t dropped_nonfinite = 0;     ///< triangles with a NaN or infinite coordinate
  /// Faces that name a vertex that does not exist. (Not those that assimp mends itself: in a glTF
  /// file it leaves the face out.)
  std::uint64_t dropped_bad_index = 0;
  std::uint64_t dropped_points_and_lines = 0;  ///< primitives that are no surface
  std::uint64_t dropped_freeform = 0;          ///< curved surfaces, which no reader knows
  /// Lines of an OBJ file with a keyword that means nothing: a slip may have been a face.
  std::uint64_t ignored_statements = 0;
  /// Whether coordinates went through single precision, as assimp keeps them. OBJ, OFF, PLY and STL
  /// files are read in doubles.
  bool single_precision = false;
  /// No coordinate of the scene is further than this from the number in the file times the scale
  /// (and the transforms that the file says). 0 where the file holds doubles or floats and the
  /// scale is 1; for decimals in doubles half a unit in the last place. What a reader of
  /// assimp's computes beyond that (curves of IFC made flat) is not in it.
  double rounding_m = 0.0;
};

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

/// Reads OBJ, OFF, PLY and STL itself (`mesh_readers/mesh_reader.h`), occupancy maps (.bt and .ot)
/// with OctoMap and any other format that assimp reads, in a child process with limits of memory
/// and time, since a hostile file of a few bytes can cost gigabytes or crash the reader; then
/// checks what came back again (indices, finiteness, counts). Never throws for a bad file. May be
/// called from any thread. A requested stop ends the import within milliseconds, and it fails.
ImportResult import_mesh(const std::filesystem::path& file, const ImportOptions& options,
                         const std::stop_token& stop = {});

}  // namespace camway::scene
