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
#include "daemon/scene/mirror/object_mirror.h"
#include "daemon/scene/voxels/voxel_map.h"

namespace camway::scene {

/// Options of what is built for each object of a scene.
struct ObjectOptions {
  IndexOptions index;
  std::optional<DistanceFieldOptions> field = DistanceFieldOptions{};  ///< nothing: no field
  std::optional<double> occupancy_resolution_m;                  ///< nothing: no occupancy mirror
  std::uint64_t mirror_voxels = ObjectMirror::kUsualMostVoxels;  ///< limit for each object
  /// Bounds of the whole scene, which no body may leave, whatever a request says. Objects and
  /// digests do not depend on them.
  geometry::Bounds bounds = {};
};

enum class ObjectKind : std::uint8_t { kMesh, kBox, kSphere, kCylinder, kPointCloud, kMap };

/// Returns "mesh", "box", "sphere", "cylinder", "point cloud" or "occupancy map".
const char* to_string(ObjectKind kind);

/// The content of an object without its placement. Immutable; scenes, revisions and histories share
/// it.
struct ObjectSource {
  ObjectKind kind = ObjectKind::kMesh;
  /// Meshes in the frame of the object (for a map see `map_origin_O`): one for a mesh or a shape;
  /// one for each brick with faces of an occupancy map, where the maps before and after a scan
  /// share equal bricks.
  std::vector<MeshPart> parts_O;
  std::shared_ptr<const VoxelMap> map_O;  ///< map whose faces the parts are; kMap only
  /// Origin of the frame of the map and of the parts in the frame of the object, which has equal
  /// axes: voxels are numbered from here. Zero for all but maps.
  geometry::Vec3 map_origin_O = geometry::Vec3::Zero();
  geometry::Box bounds_O;                        ///< bounds of all parts, in their frame
  std::shared_ptr<const DistanceField> field_O;  ///< null if there is none
  std::string why_no_field;                      ///< empty exactly when `field_O` is set
  ImportReport report;

  /// Memory that the source refers to, even if other sources refer to it too.
  [[nodiscard]] std::uint64_t memory_bytes() const;
  /// Memory that the source refers to and `other` does not. For a map after a scan, that is the
  /// memory of the parts that the scan changed.
  [[nodiscard]] std::uint64_t memory_bytes_beside(const ObjectSource& other) const;
};

/// Builds the content of an object that is no map. `report` describes the origin of the mesh.
std::shared_ptr<const ObjectSource> make_source(ObjectKind kind, Mesh mesh_O, ImportReport report,
                                                const ObjectOptions& options);

/// Builds the content of an occupancy map; `report` counts its faces. The object has no distance
/// field. A field depends on the whole map, so each scan would rebuild it; and planning in maps of
/// buildings was measured to be no more than a tenth faster with a field. `map_origin_O`: the
/// origin of the frame of the map in the frame of the object. Requires that the map has a `faces`.
std::shared_ptr<const ObjectSource> make_map_source(std::shared_ptr<const VoxelMap> map_O,
                                                    ImportReport report,
                                                    const ObjectOptions& options,
                                                    const geometry::Vec3& map_origin_O);

/// Returns the report that an import of this mesh would have made.
ImportReport report_of(const Mesh& mesh, std::string format);
/// Returns the report that an import of the faces of this map would have made. Requires that the
/// map has a `faces`.
ImportReport report_of(const VoxelMap& map, std::string format);

/// A mesh of an object, placed in the world. Immutable.
struct PlacedPart {
  std::shared_ptr<const IndexedMesh> indexed;  ///< triangles in the world, and their tree
  std::string digest;                          ///< `mesh_digest` of the triangles
};

/// An object placed in the world; paths are planned against its triangles. Immutable.
struct SceneObject {
  std::string name;
  std::shared_ptr<const ObjectSource> source;
  Placement placement;
  /// Maps the frame of the source's parts to the world: other than `placement` only for a map with
  /// an origin (`ObjectSource::map_origin_O`).
  Placement parts_placement;
  std::vector<std::shared_ptr<const PlacedPart>> parts;  ///< the source's parts, in their order
  geometry::Box bounds_W;                                ///< bounds of all parts
  std::size_t triangles = 0;
  std::shared_ptr<const ObjectMirror> occupancy;  ///< null if no resolution was given
  /// Digest of the triangles in the world: `mesh_digest` for an object of one part, a digest of the
  /// parts' digests in their order for an occupancy map. That of an object with smooth surfaces
  /// depends on their `surface_error_m`, too.
  std::string digest;

  /// The placed map if the object is an occupancy map, else nothing.
  [[nodiscard]] std::optional<PlacedVoxelMap> solid() const;
};

struct ObjectResult {
  std::shared_ptr<const SceneObject> object;  ///< null on error
  std::string error;                          ///< names the object
  Limit limit = Limit::kNone;                 ///< limit that the error is about
};

/// Places an object in the world. The cost depends on its triangles, without the parts that
/// `before` (may be null) has in the same place: these are shared. Fails if the placement moves it
/// beyond Placement::kLargestPlacedCoordinate_m, if the mirror cannot hold it, or if a stop is
/// requested while parts or mirror are made. Requires that `before` was placed with equal options.
ObjectResult place_object(std::string name, std::shared_ptr<const ObjectSource> source,
                          const Placement& placement, const ObjectOptions& options,
                          const SceneObject* before = nullptr, const std::stop_token& stop = {});

/// Digest of the triangles' coordinates in their order, 32 hexadecimal digits.
std::string mesh_digest(const Mesh& mesh);

/// Digest of texts in their order, 32 hexadecimal digits.
std::string text_digest(const std::vector<std::string>& texts);

}  // namespace camway::scene
