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
#include "daemon/scene/mirror/scene_mirror.h"
#include "daemon/scene/snapshot/scene_object.h"

namespace camway::scene {

class SceneCache;

struct SnapshotOptions : ObjectOptions {
  ImportOptions import;
};

/// Objects in the order of their names, each name once.
using SceneObjects = std::vector<std::shared_ptr<const SceneObject>>;

/// One revision of a scene. Planning reads nothing else, so a change never affects a request that
/// is being planned: it builds the next snapshot, which shares all unchanged objects, and replaces
/// this one in the store. Immutable.
struct Snapshot {
  std::string name;
  std::uint64_t revision = 1;
  /// Digest of all triangles and of the errors of smooth surfaces, 32 hexadecimal digits; equal
  /// objects in equal order have equal digests. A scene with one object has the digest of that
  /// object; a scene with several objects has a digest of their digests.
  std::string digest;
  SceneObjects objects;
  ObjectOptions options;  ///< options that objects are built with, and bounds of the scene
  WholeMesh mesh;         ///< all triangles, numbered as in `index`
  SceneIndex index;
  std::shared_ptr<const SceneSolids> solids;     ///< null if no object has an inside
  std::shared_ptr<const ClearanceField> field;   ///< null if there is none
  std::string why_no_field;                      ///< empty exactly when `field` is set
  std::shared_ptr<const SceneMirror> occupancy;  ///< null if no resolution was given
  ImportReport report;                           ///< report on all objects together

  /// The object of that name; null if there is none.
  [[nodiscard]] const SceneObject* find(std::string_view object) const;
};

struct SnapshotResult {
  std::shared_ptr<const Snapshot> snapshot;  ///< null on error
  std::string error;                         ///< names the file or the object
  Limit limit = Limit::kNone;                ///< limit that the error is about
  bool is_from_cache = false;                ///< whether the scene was found in the cache
};

/// Assembles a scene from objects. The cost depends on the number of objects and parts, not on
/// their numbers of triangles. Requires objects in the order of their names, each once, that were
/// built with `options`.
std::shared_ptr<const Snapshot> assemble(std::string name, std::uint64_t revision,
                                         SceneObjects objects, const ObjectOptions& options);

/// Makes a scene with one object, which is `mesh` and has the name of the scene.
SnapshotResult make_snapshot(std::string name, Mesh mesh, const SnapshotOptions& options = {});

/// Makes a scene with one object, which is read from `file` and has the name of the scene. Fails
/// within milliseconds after a stop is requested while the file is read or an occupancy mirror is
/// built.
///
/// If `cache` is not null, takes the scene from it, or stores it there after the import. Both give
/// the same scene, bit for bit. Occupancy maps, and files in formats that assimp reads, are not
/// cached.
SnapshotResult load_snapshot(std::string name, const std::filesystem::path& file,
                             const SnapshotOptions& options = {}, const std::stop_token& stop = {},
                             const SceneCache* cache = nullptr);

}  // namespace camway::scene
