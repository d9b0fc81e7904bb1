// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/field/clearance_field.h"
#include "daemon/scene/import/record/import_options.h"
#include "daemon/scene/import/record/import_report.h"
#include "daemon/scene/index/scene_index.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/mesh/whole_mesh.h"
#include "daemon/scene/occupancy/occupancy_mirror.h"
#include "daemon/scene/snapshot/scene_object.h"

namespace camway::scene {

struct SnapshotOptions : ObjectOptions {
  ImportOptions import;
};

/// Objects in order of their names, each name once.
using SceneObjects = std::vector<std::shared_ptr<const SceneObject>>;

/// One revision of a scene. Planning reads nothing else, so an update can never change the world
/// under a request: it builds the next snapshot and swaps. The next one shares all objects that did
/// not change.
struct Snapshot {
  std::string name;
  std::uint64_t revision = 1;
  /// Of the triangles, 32 hexadecimal digits; equal objects in equal order, equal digest. Of a
  /// single object it is that object's; of several a digest of theirs.
  std::string digest;
  SceneObjects objects;
  ObjectOptions options;  ///< what objects are built with, and its bounds
  WholeMesh mesh;         ///< numbered as `index` is
  SceneIndex index;
  std::shared_ptr<const SceneSolids> solids;         ///< null if nothing has an inside
  std::shared_ptr<const ClearanceField> field;       ///< null where it is off
  std::string why_no_field;                          ///< empty exactly when `field` is set
  std::shared_ptr<const OccupancyMirror> occupancy;  ///< null unless a resolution was given
  ImportReport report;                               ///< of all objects together

  /// Null if there is none of that name.
  [[nodiscard]] const SceneObject* find(std::string_view object) const;
};

struct SnapshotResult {
  std::shared_ptr<const Snapshot> snapshot;  ///< null on error
  std::string error;                         ///< names the file
  Limit limit = Limit::kNone;                ///< that the error is about
};

/// Puts objects together to a scene. Costs what there are objects and parts of them, whatever is in
/// these.
/// Preconditions: in order of name, each once; built with `options`.
std::shared_ptr<const Snapshot> assemble(std::string name, std::uint64_t revision,
                                         SceneObjects objects, const ObjectOptions& options);

/// A scene of one object, of the scene's name, from a mesh that is already there.
SnapshotResult make_snapshot(std::string name, Mesh mesh, const SnapshotOptions& options = {});

/// The same from a file. A requested stop ends the reading of the file, and the building of an
/// occupancy mirror, within milliseconds, and it fails.
SnapshotResult load_snapshot(std::string name, const std::filesystem::path& file,
                             const SnapshotOptions& options = {},
                             const std::stop_token& stop = {});

}  // namespace camway::scene
