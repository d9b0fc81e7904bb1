// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "daemon/scene/distance_field.h"
#include "daemon/scene/import.h"
#include "daemon/scene/mesh.h"
#include "daemon/scene/occupancy_map.h"
#include "daemon/scene/scene_index.h"

namespace camway::scene {

/// One revision of a scene. Planning reads nothing else, so an update can never change the world
/// under a request: it builds the next snapshot and swaps.
struct Snapshot {
  std::string name;
  std::uint64_t revision = 1;
  std::string digest;  ///< of the triangles, 32 hexadecimal digits; equal content, equal digest
  std::shared_ptr<const Mesh> mesh = std::make_shared<const Mesh>();  ///< never null
  SceneIndex index;
  std::shared_ptr<const DistanceField> field;     ///< null where it is off
  std::string why_no_field;                       ///< empty exactly when `field` is set
  std::shared_ptr<const OccupancyMap> occupancy;  ///< null unless a resolution was given
  ImportReport report;
};

struct SnapshotOptions {
  ImportOptions import;
  IndexOptions index;
  std::optional<DistanceFieldOptions> field = DistanceFieldOptions{};  ///< nothing: not wanted
  std::optional<double> occupancy_resolution_m;                        ///< no mirror without it
};

struct SnapshotResult {
  std::shared_ptr<const Snapshot> snapshot;  ///< null on error
  std::string error;                         ///< names the file
};

/// Digest of the triangles' coordinates and order.
std::string mesh_digest(const Mesh& mesh);

/// Builds index, distance field and mirror of a mesh that is already there.
SnapshotResult make_snapshot(std::string name, Mesh mesh, const SnapshotOptions& options = {});

/// Imports `file` and builds the snapshot.
SnapshotResult load_snapshot(std::string name, const std::filesystem::path& file,
                             const SnapshotOptions& options = {});

}  // namespace camway::scene
