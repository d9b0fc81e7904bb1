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
  std::int64_t revision = 0;  ///< number of the newest revision; increases with every change
  std::string digest;         ///< hash of all triangles; equal scenes have equal digests
  std::int64_t num_triangles = 0;
  std::array<double, 3> bounds_min_m{};  ///< lower corner of the bounding box of the triangles
  std::array<double, 3> bounds_max_m{};  ///< upper corner of the bounding box of the triangles
  Bounds body_bounds;                    ///< box that no body may leave, whatever a request says
  double occupancy_resolution_m = 0.0;   ///< edge of a voxel of the occupancy map; 0: no map
};

/// An object of a scene.
struct SceneObject {
  std::string name;
  std::string kind;    ///< "mesh", "box", "sphere", "cylinder", "point cloud", "occupancy map"
  std::string digest;  ///< hash of its triangles in the world; equal objects have equal digests
  std::int64_t num_triangles = 0;
  Pose pose;                             ///< pose of the object's own frame in the world
  std::array<double, 3> bounds_min_m{};  ///< lower corner of its bounding box in the world
  std::array<double, 3> bounds_max_m{};  ///< upper corner of its bounding box in the world
};

/// A revision of a scene that can be restored, and the change that made it.
struct SceneRevision {
  std::int64_t revision = 0;
  std::int64_t utime = 0;  ///< time of the change, microseconds since 1970
  std::string operation;   ///< "load", "put", "move", "remove", "scan" or "restore"
  std::string object;      ///< object that was changed; empty: the whole scene
  std::string client_id;   ///< client that made the change; empty: the daemon read its files
  std::int64_t restored_revision = 0;  ///< "restore": revision whose objects it has; else 0
};

/// A mesh, an OctoMap or a cloud of points in a file format that Camway reads: a file below the
/// daemon's scene roots, or bytes to upload.
struct SceneMesh {
  std::string file;                 ///< path relative to a scene root of the daemon; empty: `bytes`
  std::vector<std::uint8_t> bytes;  ///< content of a file; used if `file` is empty
  std::string format;               ///< file extension for `bytes`: "obj", "ply", "bt", ...
  double scale = 1.0;               ///< metres per unit of the file
  /// Rotation of the file's axes: none, Z up to Y up, or Y up to Z up.
  enum class Up { kAsInFile = 0, kZToY = 1, kYToZ = 2 } up = Up::kAsInFile;
  /// State of the voxels that an OctoMap does not know. `kOccupied` fills those in the box of the
  /// known voxels, and one layer of voxels around that box.
  enum class Unknown { kFree = 0, kOccupied = 1 } unknown = Unknown::kFree;
  /// Edge of the voxels of a cloud of points (PCD, XYZ, LAS), in metres. 0: about twice the
  /// distance of neighbouring points.
  double voxel_m = 0.0;
};

/// A box centred at the object's origin.
struct SceneBox {
  std::array<double, 3> size_m{};  ///< full edge lengths along x, y, z
};
/// A sphere centred at the object's origin. The triangles enclose it.
struct SceneSphere {
  double radius_m = 0.0;
  double chord_error_m = 0.0;  ///< largest distance of a triangle from it; 0: 1 % of the radius
};
/// A cylinder along the object's z axis, centred at the object's origin. The triangles enclose it.
struct SceneCylinder {
  double radius_m = 0.0;
  double height_m = 0.0;
  double chord_error_m = 0.0;  ///< largest distance of a triangle from it; 0: 1 % of the radius
};
/// A point cloud. Every cube of a grid is solid if it holds a point.
struct ScenePoints {
  std::vector<std::array<double, 3>> points_m;  ///< points in the object's frame
  double cell_m = 0.0;                          ///< edge of a cube
};
/// The sensor model of OctoMap for scans: occupancy probabilities and range (Hornung et al. 2013).
struct SceneSensor {
  double hit_probability = 0.7;       ///< for a voxel with a point [Limit: 0.5 < value < 1]
  double miss_probability = 0.4;      ///< for a voxel seen through [Limit: 0 < value < 0.5]
  double least_probability = 0.1192;  ///< lower clamp of a voxel [Limit: 0 < value < 0.5]
  double most_probability = 0.971;    ///< upper clamp of a voxel [Limit: 0.5 < value < 1]
  /// Range of the sensor; 0: no limit. A point beyond it marks free space up to the range, and no
  /// occupied voxel.
  double max_range_m = 0.0;
};
/// An OctoMap without known voxels, to be filled by `Client::insert_scan`.
struct SceneVoxels {
  double resolution_m = 0.0;  ///< edge of a voxel
  SceneMesh::Unknown unknown = SceneMesh::Unknown::kFree;
  SceneSensor sensor;
};
using SceneShape =
    std::variant<SceneMesh, SceneBox, SceneSphere, SceneCylinder, ScenePoints, SceneVoxels>;

/// The result of a call about scenes.
struct SceneAnswer {
  Status status = Status::kNoAnswer;
  std::string error;  ///< the failure and its remedy; empty when `ok()`

  bool ok() const { return status == Status::kOk; }

  DaemonStart daemon_start;       ///< of the daemon that answered
  std::string message;            ///< warnings of the import of a file; empty if there are none
  SceneInfo scene;                ///< the scene after the change; empty for `list_scenes`
  std::vector<SceneInfo> scenes;  ///< `list_scenes`: all scenes, in order of name
  /// `describe_scene`: all objects, in order of name. Other calls: the object that was changed.
  std::vector<SceneObject> objects;
  std::vector<SceneRevision> revisions;  ///< `scene_history`: all revisions, oldest first
};

/// The occupancy map of a scene, as a file.
struct SceneMap {
  Status status = Status::kNoAnswer;
  std::string error;  ///< the failure and its remedy; empty when `ok()`

  bool ok() const { return status == Status::kOk; }

  SceneInfo scene;                  ///< scene to which the map belongs
  std::vector<std::uint8_t> bytes;  ///< content of a file in OctoMap's binary format (.bt)
};

/// The triangles of an object.
struct SceneTriangles {
  Status status = Status::kNoAnswer;
  std::string error;  ///< the failure and its remedy; empty when `ok()`

  bool ok() const { return status == Status::kOk; }

  SceneInfo scene;     ///< revision of the scene in which the object was found
  SceneObject object;  ///< the object, with its pose in that revision
  /// Vertices in the frame of the object, as the daemon has them: `object.pose` takes them to the
  /// world.
  std::vector<std::array<double, 3>> vertices_m;
  /// Indices of vertices; in the order in which answers number the triangles of the scene.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// A named range of triangles, as the file of the object has them.
  struct Part {
    std::string name;
    std::uint32_t num_triangles = 0;
  };
  std::vector<Part> parts;       ///< in order; together they have all triangles
  double surface_error_m = 0.0;  ///< paths keep this distance from triangles of smooth surfaces
  /// Whether the object is an occupancy map: its triangles are the faces of its voxels, and what is
  /// inside of them collides, too.
  bool has_inside = false;
};

}  // namespace camway
