// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "daemon/geometry/bounds.h"
#include "daemon/scene/field/distance_field.h"
#include "daemon/scene/import/record/import_report.h"
#include "daemon/scene/index/index_tree.h"
#include "daemon/scene/mesh/mesh.h"
#include "daemon/scene/mesh/placement.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/occupancy/occupancy_map.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

/// What is built for each object of a scene.
struct ObjectOptions {
  IndexOptions index;
  std::optional<DistanceFieldOptions> field = DistanceFieldOptions{};  ///< nothing: not wanted
  std::optional<double> occupancy_resolution_m;                        ///< no mirror without it
  std::uint64_t mirror_voxels = OccupancyMap::kUsualMostVoxels;        ///< of an object, at most
  /// Of the scene: what no body may leave, whatever a request says. No object, and no digest,
  /// depends on it.
  geometry::Bounds bounds = {};
};

enum class ObjectKind : std::uint8_t { kMesh, kBox, kSphere, kCylinder, kPointCloud, kMap };

/// The word for a kind: "mesh", "box", "sphere", "cylinder", "point cloud", "occupancy map".
const char* to_string(ObjectKind kind);

/// What an object is, wherever it is. Immutable, so that scenes, revisions and their history share
/// it.
struct ObjectSource {
  ObjectKind kind = ObjectKind::kMesh;
  /// In the object's own frame. A mesh, or a shape, is one part; an occupancy map has one for each
  /// brick with faces, which the maps before and after a scan share where they are alike.
  std::vector<MeshPart> parts_O;
  std::shared_ptr<const VoxelMap> map_O;         ///< of kMap: what the parts are the faces of
  geometry::Box bounds_O;                        ///< of all parts
  std::shared_ptr<const DistanceField> field_O;  ///< null where it is off
  std::string why_no_field;                      ///< empty exactly when `field_O` is set
  ImportReport report;

  /// What the source refers to, also where other sources refer to it as well.
  [[nodiscard]] std::uint64_t memory_bytes() const;
  /// The same, without what `other` refers to: of a map after a scan, what the scan changed.
  [[nodiscard]] std::uint64_t memory_bytes_beside(const ObjectSource& other) const;
};

/// Builds what does not depend on where the object is. `report` says how the mesh came to be.
/// Precondition: not kMap.
std::shared_ptr<const ObjectSource> make_source(ObjectKind kind, Mesh mesh_O, ImportReport report,
                                                const ObjectOptions& options);

/// The same of an occupancy map, of which `report` counts the faces. It has no distance field:
/// one depends on all of the map, so a scan would have to build it anew, and measured on maps of
/// buildings planning is no more than a tenth faster with it. Precondition: the map has a skin.
std::shared_ptr<const ObjectSource> make_map_source(std::shared_ptr<const VoxelMap> map_O,
                                                    ImportReport report,
                                                    const ObjectOptions& options);

/// What an import would have reported of a mesh that is already there.
ImportReport report_of(const Mesh& mesh, std::string format);
/// Likewise of the faces of a map. Precondition: it has a skin.
ImportReport report_of(const VoxelMap& map, std::string format);

/// A part of an object in its place. Immutable.
struct PlacedPart {
  std::shared_ptr<const IndexedMesh> indexed;  ///< its triangles in the world, and their tree
  std::string digest;                          ///< `mesh_digest` of them
};

/// An object in its place: what paths are planned against. Immutable.
struct SceneObject {
  std::string name;
  std::shared_ptr<const ObjectSource> source;
  Placement placement;
  std::vector<std::shared_ptr<const PlacedPart>> parts;  ///< of the source's, in their order
  geometry::Box bounds_W;                                ///< of all of them
  std::size_t triangles = 0;
  std::shared_ptr<const OccupancyMap> occupancy;  ///< null unless a resolution was given
  /// Of the triangles in the world: of an object of one part `mesh_digest`, of an occupancy map a
  /// digest of those of its parts in their order.
  std::string digest;

  /// Of an occupancy map: where it is.
  [[nodiscard]] std::optional<PlacedVoxelMap> solid() const;
};

struct ObjectResult {
  std::shared_ptr<const SceneObject> object;  ///< null on error
  std::string error;                          ///< names the object
  Limit limit = Limit::kNone;                 ///< that the error is about
};

/// Puts an object in its place. Costs what there are triangles in it, but for parts that `before`,
/// which may be null, has in the same place: these it shares. Refuses one that lies beyond
/// Placement::kLargestCoordinateM there, or that the mirror cannot hold. A `stop` that is asked for
/// ends the making of parts and of the mirror, and it fails. Precondition: `before` was placed with
/// equal options.
ObjectResult place_object(std::string name, std::shared_ptr<const ObjectSource> source,
                          const Placement& placement, const ObjectOptions& options,
                          const SceneObject* before = nullptr, const std::stop_token& stop = {});

/// Digest of the triangles' coordinates and order, 32 hexadecimal digits.
std::string mesh_digest(const Mesh& mesh);

/// Digest of texts in their order, likewise.
std::string text_digest(const std::vector<std::string>& texts);

}  // namespace camway::scene
