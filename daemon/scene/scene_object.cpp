// SPDX-License-Identifier: MIT
#include "daemon/scene/scene_object.h"

#include <xxhash.h>

#include <cassert>
#include <cstdio>
#include <utility>

namespace camway::scene {
namespace {

class Digest {
 public:
  Digest() { XXH3_128bits_reset(state_.get()); }

  void add(const void* bytes, std::size_t size) { XXH3_128bits_update(state_.get(), bytes, size); }

  [[nodiscard]] std::string text() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    char text[33];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                  static_cast<unsigned long long>(hash.low64));
    return text;
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_{XXH3_createState()};
};

std::shared_ptr<const Mesh> mesh_in_world(const ObjectSource& source, const Placement& placement) {
  if (placement.is_identity()) return source.mesh_O;
  return std::make_shared<const Mesh>(placed_mesh(*source.mesh_O, placement));
}

bool is_too_far(const geometry::Box& bounds) {
  return !bounds.isEmpty() &&
         !(bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).maxCoeff() <=
           Placement::kLargestCoordinateM);
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
  return mesh_O->vertices.capacity() * sizeof(geometry::Vec3) +
         mesh_O->triangles.capacity() * sizeof(mesh_O->triangles[0]) +
         (field_O ? field_O->statistics().memory_bytes : 0) + (map_O ? map_O->memory_bytes() : 0);
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

std::shared_ptr<const ObjectSource> make_source(ObjectKind kind, Mesh mesh_O, ImportReport report,
                                                const ObjectOptions& options,
                                                std::shared_ptr<const VoxelMap> map_O) {
  assert((kind == ObjectKind::kMap) == (map_O != nullptr));
  auto source = std::make_shared<ObjectSource>();
  source->kind = kind;
  source->bounds_O = mesh_O.bounds();
  source->report = std::move(report);
  source->map_O = std::move(map_O);
  if (options.field) {
    DistanceFieldResult result = DistanceField::build(mesh_O, *options.field);
    source->field_O = std::move(result.field);
    source->why_no_field = std::move(result.why_off);
  } else {
    source->why_no_field = "it was not asked for";
  }
  source->mesh_O = std::make_shared<const Mesh>(std::move(mesh_O));
  return source;
}

std::optional<PlacedVoxelMap> SceneObject::solid() const {
  if (!source->map_O) return std::nullopt;
  return PlacedVoxelMap{source->map_O, placement, placed->tree.bounds()};
}

ObjectResult place_object(std::string name, std::shared_ptr<const ObjectSource> source,
                          const Placement& placement, const ObjectOptions& options) {
  assert(source);
  auto object = std::make_shared<SceneObject>();
  const std::shared_ptr<const Mesh> mesh_W = mesh_in_world(*source, placement);
  // What was imported where it is keeps its own, wider limit.
  if (!placement.is_identity() && is_too_far(mesh_W->bounds())) {
    return {nullptr, name + ": would lie more than 1e9 m from the origin"};
  }
  object->digest = mesh_digest(*mesh_W);
  if (source->map_O) object->digest = text_digest({object->digest, "solid"});
  object->placed = IndexedMesh::build(mesh_W, options.index);
  object->source = std::move(source);
  object->placement = placement;
  if (options.occupancy_resolution_m) {
    OccupancyMap::BuildResult mirror = OccupancyMap::build(*mesh_W, *options.occupancy_resolution_m,
                                                           object->solid(), options.mirror_voxels);
    if (!mirror.map) return {nullptr, name + ": " + mirror.error, mirror.limit};
    object->occupancy = std::move(mirror.map);
  }
  object->name = std::move(name);
  return {std::move(object), ""};
}

std::string mesh_digest(const Mesh& mesh) {
  Digest digest;
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
  Digest digest;
  for (const std::string& text : texts) digest.add(text.c_str(), text.size() + 1);
  return digest.text();
}

}  // namespace camway::scene
