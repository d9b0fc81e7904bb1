// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/scene/distance_field.h"
#include "daemon/scene/import.h"
#include "daemon/scene/index_tree.h"
#include "daemon/scene/limit.h"
#include "daemon/scene/mesh.h"
#include "daemon/scene/occupancy_map.h"
#include "daemon/scene/placement.h"
#include "daemon/scene/voxel_map.h"

namespace camway::scene {

/// What is built for each object of a scene.
struct ObjectOptions {
  IndexOptions index;
  std::optional<DistanceFieldOptions> field = DistanceFieldOptions{};  ///< nothing: not wanted
  std::optional<double> occupancy_resolution_m;                        ///< no mirror without it
  std::uint64_t mirror_voxels = OccupancyMap::kUsualMostVoxels;        ///< of an object, at most
};

enum class ObjectKind : std::uint8_t { kMesh, kBox, kSphere, kCylinder, kPointCloud, kMap };

/// The word for a kind: "mesh", "box", "sphere", "cylinder", "point cloud", "occupancy map".
const char* to_string(ObjectKind kind);

/// What an object is, wherever it is. Immutable, so that scenes, revisions and their history share
/// it.
struct ObjectSource {
  ObjectKind kind = ObjectKind::kMesh;
  std::shared_ptr<const Mesh> mesh_O;            ///< in the object's own frame; never null
  std::shared_ptr<const VoxelMap> map_O;         ///< of kMap: what the mesh is the faces of
  geometry::Box bounds_O;                        ///< of it
  std::shared_ptr<const DistanceField> field_O;  ///< null where it is off
  std::string why_no_field;                      ///< empty exactly when `field_O` is set
  ImportReport report;

  [[nodiscard]] std::uint64_t memory_bytes() const;
};

/// Builds what does not depend on where the object is. `report` says how the mesh came to be; of an
/// occupancy map it is the faces of `map_O`.
std::shared_ptr<const ObjectSource> make_source(ObjectKind kind, Mesh mesh_O, ImportReport report,
                                                const ObjectOptions& options,
                                                std::shared_ptr<const VoxelMap> map_O = nullptr);

/// What an import would have reported of a mesh that is already there.
ImportReport report_of(const Mesh& mesh, std::string format);

/// An object in its place: what paths are planned against. Immutable.
struct SceneObject {
  std::string name;
  std::shared_ptr<const ObjectSource> source;
  Placement placement;
  std::shared_ptr<const IndexedMesh> placed;      ///< its triangles in the world, and their tree
  std::shared_ptr<const OccupancyMap> occupancy;  ///< null unless a resolution was given
  /// `mesh_digest` of the triangles in the world; of a solid another one than of its surface.
  std::string digest;

  /// Of an occupancy map: where it is.
  [[nodiscard]] std::optional<PlacedVoxelMap> solid() const;
};

struct ObjectResult {
  std::shared_ptr<const SceneObject> object;  ///< null on error
  std::string error;                          ///< names the object
  Limit limit = Limit::kNone;                 ///< that the error is about
};

/// Puts an object in its place. Costs what there are triangles in it. Refuses one that lies beyond
/// Placement::kLargestCoordinateM there, or that the mirror cannot hold.
ObjectResult place_object(std::string name, std::shared_ptr<const ObjectSource> source,
                          const Placement& placement, const ObjectOptions& options);

/// Digest of the triangles' coordinates and order, 32 hexadecimal digits.
std::string mesh_digest(const Mesh& mesh);

/// Digest of texts in their order, likewise.
std::string text_digest(const std::vector<std::string>& texts);

}  // namespace camway::scene
