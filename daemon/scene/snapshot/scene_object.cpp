// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/scene_object.h"

#include <array>
#include <cassert>
#include <charconv>
#include <utility>

#include "daemon/base/digest.h"
#include "daemon/base/parallel_chunks.h"

namespace camway::scene {
namespace {

/// Memory of a part beside its vertices and triangles: the mesh, its object, the control block and
/// the entry in the list.
constexpr std::uint64_t kBytesBesideAPart =
    sizeof(MeshPart) + sizeof(Mesh) + sizeof(MeshObject) + 6 * sizeof(void*);

std::shared_ptr<const Mesh> mesh_in_world(const MeshPart& part, const Placement& placement) {
  if (placement.is_identity()) return part.mesh;
  return std::make_shared<const Mesh>(placed_mesh(*part.mesh, placement));
}

std::shared_ptr<const PlacedPart> placed(const MeshPart& part, const Placement& placement,
                                         const IndexOptions& options) {
  auto result = std::make_shared<PlacedPart>();
  result->indexed = IndexedMesh::build(mesh_in_world(part, placement), options);
  result->digest = mesh_digest(*result->indexed->mesh);
  return result;
}

/// For each part of `source` the part of `before` that is equal and in the same place, or null.
std::vector<std::shared_ptr<const PlacedPart>> parts_there(const ObjectSource& source,
                                                           const Placement& placement,
                                                           const SceneObject* before) {
  std::vector<std::shared_ptr<const PlacedPart>> parts(source.parts_O.size());
  if (before == nullptr || !(before->parts_placement == placement)) return parts;
  const std::vector<MeshPart>& olds = before->source->parts_O;
  std::size_t old = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const MeshPart& part = source.parts_O[i];
    while (old < olds.size() && olds[old].key < part.key) ++old;
    if (old < olds.size() && olds[old].mesh == part.mesh) parts[i] = before->parts[old];
  }
  return parts;
}

/// Some are null if a stop is requested.
std::vector<std::shared_ptr<const PlacedPart>> placed_parts(const ObjectSource& source,
                                                            const Placement& placement,
                                                            const IndexOptions& options,
                                                            const SceneObject* before,
                                                            const std::stop_token& stop) {
  std::vector<std::shared_ptr<const PlacedPart>> parts = parts_there(source, placement, before);
  if (parts.size() == 1) {
    if (!parts[0]) parts[0] = placed(source.parts_O[0], placement, options);
    return parts;
  }
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i]) missing.push_back(i);
  }
  IndexOptions of_one = options;
  of_one.threads = 1;
  base::for_each_chunk(base::chunk_threads(options.threads), missing.size(),
                       [&](unsigned, std::size_t i) {
                         if (stop.stop_requested()) return;
                         parts[missing[i]] = placed(source.parts_O[missing[i]], placement, of_one);
                       });
  return parts;
}

/// A path keeps that distance from the triangles, too, so they alone do not determine the answer.
std::string with_surface_error(const std::string& digest, double surface_error_m) {
  if (surface_error_m == 0.0) return digest;
  std::array<char, 32> error{};
  const auto end = std::to_chars(error.data(), error.data() + error.size(), surface_error_m,
                                 std::chars_format::hex);
  return text_digest({digest, "surface error", std::string(error.data(), end.ptr)});
}

std::string digest_of(const SceneObject& object) {
  if (!object.source->map_O) {
    return with_surface_error(object.parts.front()->digest, object.source->report.surface_error_m);
  }
  std::vector<std::string> digests;
  digests.reserve(object.parts.size() + 1);
  for (const auto& part : object.parts) digests.push_back(part->digest);
  digests.emplace_back("solid");  // differs from its surface alone
  return text_digest(digests);
}

/// Whether the voxels of the mirror are those of the object's map.
bool has_own_voxels(const SceneObject& object, const ObjectOptions& options) {
  return object.source->map_O && object.parts_placement.is_identity() &&
         object.source->map_O->resolution_m() == *options.occupancy_resolution_m;
}

ObjectMirror::BuildResult mirror_of(const SceneObject& object, const ObjectOptions& options,
                                    const SceneObject* before, const std::stop_token& stop) {
  if (has_own_voxels(object, options)) {
    const bool is_like_before = before != nullptr && has_own_voxels(*before, options);
    return ObjectMirror::of_map(*object.source->map_O, object.source->bounds_O,
                                options.mirror_voxels,
                                is_like_before ? before->occupancy.get() : nullptr,
                                is_like_before ? before->source->map_O.get() : nullptr, stop);
  }
  std::vector<const Mesh*> meshes;
  meshes.reserve(object.parts.size());
  for (const auto& part : object.parts) meshes.push_back(part->indexed->mesh.get());
  return ObjectMirror::build(meshes, *options.occupancy_resolution_m, object.solid(),
                             options.mirror_voxels, stop);
}

bool is_too_far(const geometry::Box& bounds) {
  return !bounds.isEmpty() &&
         !(bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).maxCoeff() <=
           Placement::kLargestPlacedCoordinate_m);
}

}  // namespace

const char* to_string(ObjectKind kind) {
  switch (kind) {
    case ObjectKind::kMesh:
      return "mesh";
    case ObjectKind::kBox:
      return "box";
    case ObjectKind::kSphere:
      return "sphere";
    case ObjectKind::kCylinder:
      return "cylinder";
    case ObjectKind::kPointCloud:
      return "point cloud";
    case ObjectKind::kMap:
      return "occupancy map";
  }
  return "unknown";
}

std::uint64_t ObjectSource::memory_bytes() const {
  std::uint64_t bytes =
      (field_O ? field_O->statistics().memory_bytes : 0) + (map_O ? map_O->memory_bytes() : 0);
  for (const MeshPart& part : parts_O) bytes += part.mesh->memory_bytes() + kBytesBesideAPart;
  return bytes;
}

std::uint64_t ObjectSource::memory_bytes_beside(const ObjectSource& other) const {
  if (this == &other) return 0;
  std::uint64_t bytes = 0;
  if (field_O && field_O != other.field_O) bytes += field_O->statistics().memory_bytes;
  if (map_O && map_O != other.map_O) {
    bytes += other.map_O ? map_O->memory_bytes_beside(*other.map_O) : map_O->memory_bytes();
  }
  auto theirs = other.parts_O.begin();
  for (const MeshPart& part : parts_O) {
    while (theirs != other.parts_O.end() && theirs->key < part.key) ++theirs;
    const bool is_shared = theirs != other.parts_O.end() && theirs->mesh == part.mesh;
    bytes += is_shared ? sizeof(MeshPart) : part.mesh->memory_bytes() + kBytesBesideAPart;
  }
  return bytes;
}

ImportReport report_of(const Mesh& mesh, std::string format) {
  ImportReport report;
  report.format = std::move(format);
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  report.objects = mesh.objects.size();
  report.bounds_m = mesh.bounds();
  return report;
}

ImportReport report_of(const VoxelMap& map, std::string format) {
  ImportReport report;
  report.format = std::move(format);
  report.objects = 1;
  for (const MeshPart& part : map.faces()->parts()) {
    report.vertices += part.mesh->vertices.size();
    report.triangles += part.mesh->triangles.size();
    report.bounds_m.extend(part.bounds);
  }
  return report;
}

std::shared_ptr<const ObjectSource> make_source(ObjectKind kind, Mesh mesh_O, ImportReport report,
                                                const ObjectOptions& options) {
  assert(kind != ObjectKind::kMap);
  auto source = std::make_shared<ObjectSource>();
  source->kind = kind;
  source->report = std::move(report);
  if (options.field) {
    base::Result<std::shared_ptr<const DistanceField>> result =
        DistanceField::build(mesh_O, *options.field);
    if (result) source->field_O = *std::move(result);
    source->why_no_field = std::move(result.error);
  } else {
    source->why_no_field = "it was not asked for";
  }
  source->parts_O.push_back(MeshPart::of(0, std::move(mesh_O)));
  source->bounds_O = source->parts_O.front().bounds;
  return source;
}

std::shared_ptr<const ObjectSource> make_map_source(std::shared_ptr<const VoxelMap> map_O,
                                                    ImportReport report,
                                                    const ObjectOptions& options,
                                                    const geometry::Vec3& map_origin_O) {
  assert(map_O && map_O->faces());
  auto source = std::make_shared<ObjectSource>();
  source->kind = ObjectKind::kMap;
  source->report = std::move(report);
  source->parts_O = map_O->faces()->parts();
  for (const MeshPart& part : source->parts_O) source->bounds_O.extend(part.bounds);
  source->why_no_field =
      options.field ? "occupancy maps have none, so that scans are quick" : "it was not asked for";
  source->map_O = std::move(map_O);
  source->map_origin_O = map_origin_O;
  return source;
}

std::optional<PlacedVoxelMap> SceneObject::solid() const {
  if (!source->map_O) return std::nullopt;
  return PlacedVoxelMap{source->map_O, parts_placement, bounds_W};
}

ObjectResult place_object(std::string name, std::shared_ptr<const ObjectSource> source,
                          const Placement& placement, const ObjectOptions& options,
                          const SceneObject* before, const std::stop_token& stop) {
  assert(source);
  auto object = std::make_shared<SceneObject>();
  const Placement of_parts = placement.with_origin(source->map_origin_O);
  object->parts = placed_parts(*source, of_parts, options.index, before, stop);
  if (stop.stop_requested()) return {nullptr, name + ": making it was cancelled"};
  for (const auto& part : object->parts) {
    object->bounds_W.extend(part->indexed->tree.bounds());
    object->triangles += part->indexed->mesh->triangles.size();
  }
  // An object imported with the identity keeps its own, wider limit.
  if (!of_parts.is_identity() && is_too_far(object->bounds_W)) {
    return {nullptr, name + ": would lie more than 1e9 m from the origin"};
  }
  object->source = std::move(source);
  object->placement = placement;
  object->parts_placement = of_parts;
  object->digest = digest_of(*object);
  if (options.occupancy_resolution_m) {
    ObjectMirror::BuildResult mirror = mirror_of(*object, options, before, stop);
    if (!mirror.map) return {nullptr, name + ": " + mirror.error, mirror.limit};
    object->occupancy = std::move(mirror.map);
  }
  object->name = std::move(name);
  return {std::move(object), ""};
}

std::string mesh_digest(const Mesh& mesh) {
  base::Digest digest;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<double, 9> coordinates{};
    std::size_t at = 0;
    for (const geometry::Vec3& v : mesh.triangle(i)) {
      for (int k = 0; k < 3; ++k) coordinates[at++] = v[k] + 0.0;  // -0 is the same point as 0
    }
    digest.add(coordinates.data(), sizeof coordinates);
  }
  return digest.text();
}

std::string text_digest(const std::vector<std::string>& texts) {
  base::Digest digest;
  for (const std::string& text : texts) digest.add(text.c_str(), text.size() + 1);
  return digest.text();
}

}  // namespace camway::scene
