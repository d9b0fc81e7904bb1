// SPDX-License-Identifier: MIT
#pragma once

#include <camway/constraints.h>
#include <camway/path.h>
#include <camway/status.h>

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace camway {

/// A scene that the daemon holds.
struct SceneInfo {
  std::string name;
  std::int64_t revision = 0;  ///< increases with every change
  std::string digest;         ///< of the triangles; equal content, equal digest
  std::int64_t num_triangles = 0;
  std::array<double, 3> bounds_min_m{};  ///< of the triangles
  std::array<double, 3> bounds_max_m{};
  Bounds body_bounds;                   ///< what no body may leave in it
  double occupancy_resolution_m = 0.0;  ///< 0: no occupancy map
};

/// An object of a scene.
struct SceneObject {
  std::string name;
  std::string kind;  ///< "mesh", "box", "sphere", "cylinder", "point cloud", "occupancy map"
  std::string digest;
  std::int64_t num_triangles = 0;
  Pose pose;  ///< of the object's own frame in the world
  std::array<double, 3> bounds_min_m{};
  std::array<double, 3> bounds_max_m{};
};

/// A revision of a scene that can be had again, and the change that led to it.
struct SceneRevision {
  std::int64_t revision = 0;
  std::int64_t utime = 0;  ///< when it was made, microseconds since 1970
  std::string operation;   ///< "load", "put", "move", "remove", "scan" or "restore"
  std::string object;      ///< that was changed; empty: all of the scene
  std::string client_id;   ///< who asked for it; empty: nobody, the daemon read its files
  std::int64_t restored_revision = 0;  ///< of "restore": whose objects it has again; else 0
};

/// A mesh, or an OctoMap, that is a file in any format that Camway reads: one that the daemon finds
/// below its scene roots, or bytes that are uploaded.
struct SceneMesh {
  std::string file;                 ///< relative to a scene root of the daemon; empty for bytes
  std::vector<std::uint8_t> bytes;  ///< the content of a file
  std::string format;  ///< extension that says the format of `bytes`: "obj", "ply", "bt", ...
  double scale = 1.0;  ///< file units to metres
  enum class Up { kAsInFile = 0, kZToY = 1, kYToZ = 2 } up = Up::kAsInFile;
  /// Of an OctoMap: what it knows nothing of. Occupied: all within the box of what it knows, and a
  /// layer of voxels about it.
  enum class Unknown { kFree = 0, kOccupied = 1 } unknown = Unknown::kFree;
};

/// About the object's origin.
struct SceneBox {
  std::array<double, 3> size_m{};
};
/// Enclosed by triangles that stand out by the chord error at most, by default a hundredth of the
/// radius.
struct SceneSphere {
  double radius_m = 0.0;
  double chord_error_m = 0.0;
};
/// Likewise, about the axis z and the middle of its height.
struct SceneCylinder {
  double radius_m = 0.0;
  double height_m = 0.0;
  double chord_error_m = 0.0;
};
/// Cubes of a grid that hold a point are solid.
struct ScenePoints {
  std::vector<std::array<double, 3>> points_m;
  double cell_m = 0.0;
};
/// How far the scans of a sensor are to be believed, as OctoMap has it.
struct SceneSensor {
  double hit_probability = 0.7;       ///< of a voxel that was seen [Limit: 0.5 < value < 1]
  double miss_probability = 0.4;      ///< of one that was seen through [Limit: 0 < value < 0.5]
  double least_probability = 0.1192;  ///< nothing is surer to be free [Limit: 0 < value < 0.5]
  double most_probability = 0.971;    ///< nor occupied [Limit: 0.5 < value < 1]
  double max_range_m = 0.0;  ///< points further away only say what is free up to there; 0: no limit
};
/// An OctoMap that knows nothing before it is scanned.
struct SceneVoxels {
  double resolution_m = 0.0;  ///< edge of a voxel
  SceneMesh::Unknown unknown = SceneMesh::Unknown::kFree;
  SceneSensor sensor;
};
using SceneShape =
    std::variant<SceneMesh, SceneBox, SceneSphere, SceneCylinder, ScenePoints, SceneVoxels>;

/// What a call about scenes came to.
struct SceneAnswer {
  Status status = Status::kNoAnswer;
  std::string error;  ///< what failed and what to do about it; empty when `ok()`

  bool ok() const { return status == Status::kOk; }

  std::string message;               ///< warnings about a file; empty when there is nothing to say
  SceneInfo scene;                   ///< as it is now, after the change; not of `list_scenes`
  std::vector<SceneInfo> scenes;     ///< of `list_scenes`, in order of name
  std::vector<SceneObject> objects;  ///< of `describe_scene`, in order; else the one that changed
  std::vector<SceneRevision> revisions;  ///< of `scene_history`, oldest first
};

/// An occupancy map that the daemon sent.
struct SceneMap {
  Status status = Status::kNoAnswer;
  std::string error;  ///< what failed and what to do about it; empty when `ok()`

  bool ok() const { return status == Status::kOk; }

  SceneInfo scene;                  ///< of which it is the map
  std::vector<std::uint8_t> bytes;  ///< a file in OctoMap's binary format (.bt)
};

}  // namespace camway
