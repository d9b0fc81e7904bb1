// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/snapshot.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "daemon/scene/cache/scene_cache.h"
#include "daemon/scene/import/import.h"

namespace camway::scene {
namespace {

SnapshotResult build(std::string name, std::shared_ptr<const ObjectSource> source,
                     const ObjectOptions& options, const std::stop_token& stop,
                     const SceneObject* before = nullptr) {
  ObjectResult result = place_object(name, std::move(source), {}, options, before, stop);
  if (!result.object) return {nullptr, result.error, result.limit};
  return {assemble(std::move(name), 1, {std::move(result.object)}, options), ""};
}

/// The scene of what was prepared, which is placed as the object before it was.
SnapshotResult build(std::string name, PreparedScene prepared, const ObjectOptions& options,
                     const std::stop_token& stop) {
  const std::shared_ptr<const Mesh>& mesh = prepared.indexed->mesh;
  auto source = std::make_shared<ObjectSource>();
  source->parts_O.push_back({0, mesh, prepared.report.bounds_m});
  source->bounds_O = prepared.report.bounds_m;
  source->field_O = std::move(prepared.field);
  source->why_no_field = std::move(prepared.why_no_field);
  source->report = std::move(prepared.report);
  SceneObject object;
  object.source = source;
  object.parts.push_back(std::make_shared<const PlacedPart>(
      PlacedPart{std::move(prepared.indexed), std::move(prepared.digest)}));
  return build(std::move(name), std::move(source), options, stop, &object);
}

/// Requires an object with one part that stands where its file has it.
PreparedScene prepared_of(const SceneObject& object) {
  const ObjectSource& source = *object.source;
  const PlacedPart& part = *object.parts.front();
  return {part.indexed, source.report, source.field_O, source.why_no_field, part.digest};
}

/// Adds the name of the file to an error about its object.
SnapshotResult named_after(const std::filesystem::path& file, SnapshotResult result) {
  if (!result.snapshot) result.error = file.string() + ": " + result.error;
  return result;
}

std::string digest_of(const SceneObjects& objects) {
  if (objects.empty()) return mesh_digest(Mesh());
  if (objects.size() == 1) return objects.front()->digest;
  std::vector<std::string> digests;
  digests.reserve(objects.size());
  for (const auto& object : objects) digests.push_back(object->digest);
  return text_digest(digests);
}

void add(const SceneObject& object, ImportReport& sum) {
  const ImportReport& report = object.source->report;
  sum.vertices += report.vertices;
  sum.triangles += report.triangles;
  sum.objects += report.objects;
  sum.bounds_m.extend(object.bounds_W);
  sum.degenerate_triangles += report.degenerate_triangles;
  sum.dropped_nonfinite += report.dropped_nonfinite;
  sum.dropped_bad_index += report.dropped_bad_index;
  sum.dropped_points_and_lines += report.dropped_points_and_lines;
  sum.dropped_freeform += report.dropped_freeform;
  sum.ignored_statements += report.ignored_statements;
  sum.single_precision = sum.single_precision || report.single_precision;
  sum.rounding_m = std::max(sum.rounding_m, report.rounding_m);
  sum.surface_error_m = std::max(sum.surface_error_m, report.surface_error_m);
}

ImportReport report_of(const SceneObjects& objects) {
  if (objects.size() == 1) {
    ImportReport report = objects.front()->source->report;
    report.bounds_m = objects.front()->bounds_W;
    return report;
  }
  ImportReport sum;
  sum.format = "several objects";
  for (const auto& object : objects) add(*object, sum);
  return sum;
}

void make_field(Snapshot& snapshot) {
  std::vector<PlacedField> fields;
  const ObjectSource* without = nullptr;  ///< an object that has triangles but no field
  for (const auto& object : snapshot.objects) {
    const ObjectSource& source = *object->source;
    if (object->triangles == 0) continue;
    fields.push_back({source.field_O, object->placement, source.bounds_O, object->bounds_W});
    if (!source.field_O) without = &source;
  }
  if (fields.empty()) {
    snapshot.why_no_field =
        snapshot.options.field ? "the scene has no triangles" : "it was not asked for";
  } else if (fields.size() > ClearanceField::kMaxObjects) {
    snapshot.why_no_field =
        "the scene has more than " + std::to_string(ClearanceField::kMaxObjects) + " objects";
  } else if (std::ranges::none_of(fields, [](const auto& f) { return f.field_O != nullptr; })) {
    snapshot.why_no_field = without->why_no_field;
  } else {
    snapshot.field = std::make_shared<const ClearanceField>(fields);
  }
}

}  // namespace

const SceneObject* Snapshot::find(std::string_view object) const {
  const auto found = std::ranges::lower_bound(
      objects, object, {}, [](const auto& each) { return std::string_view(each->name); });
  return found != objects.end() && (*found)->name == object ? found->get() : nullptr;
}

std::shared_ptr<const Snapshot> assemble(std::string name, std::uint64_t revision,
                                         SceneObjects objects, const ObjectOptions& options) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->name = std::move(name);
  snapshot->revision = revision;
  snapshot->options = options;
  snapshot->digest = digest_of(objects);
  snapshot->report = report_of(objects);
  std::vector<WholeMesh::Part> meshes;
  std::vector<std::shared_ptr<const IndexedMesh>> indexed;
  std::vector<std::shared_ptr<const ObjectMirror>> maps;
  std::vector<PlacedVoxelMap> solids;
  for (const auto& object : objects) {
    assert(object->occupancy || !options.occupancy_resolution_m);
    WholeMesh::Part part{object->name, {}};
    for (const auto& placed : object->parts) {
      part.meshes.push_back(placed->indexed->mesh);
      indexed.push_back(placed->indexed);
    }
    meshes.push_back(std::move(part));
    if (object->occupancy) maps.push_back(object->occupancy);
    if (auto solid = object->solid()) solids.push_back(*std::move(solid));
  }
  snapshot->mesh = WholeMesh(std::move(meshes));
  snapshot->index = SceneIndex::of(indexed);
  if (options.occupancy_resolution_m) {
    snapshot->occupancy =
        std::make_shared<const SceneMirror>(*options.occupancy_resolution_m, std::move(maps));
  }
  if (!solids.empty()) snapshot->solids = std::make_shared<const SceneSolids>(std::move(solids));
  snapshot->objects = std::move(objects);
  make_field(*snapshot);
  return snapshot;
}

SnapshotResult make_snapshot(std::string name, Mesh mesh, const SnapshotOptions& options) {
  ImportReport report = scene::report_of(mesh, "memory");
  return build(std::move(name),
               make_source(ObjectKind::kMesh, std::move(mesh), std::move(report), options), options,
               {});
}

SnapshotResult load_snapshot(std::string name, const std::filesystem::path& file,
                             const SnapshotOptions& options, const std::stop_token& stop,
                             const SceneCache* cache) {
  const PreparationOptions preparation{options.import, options.index, options.field};
  const std::optional<SceneKey> key =
      cache != nullptr ? scene_key(file, preparation) : std::nullopt;
  if (key) {
    if (auto prepared = cache->find(*key, options.import)) {
      SnapshotResult result = build(std::move(name), *std::move(prepared), options, stop);
      result.is_from_cache = true;
      return named_after(file, std::move(result));
    }
  }
  ImportResult import = import_mesh(file, options.import, stop);
  if (!import.mesh) return {nullptr, import.error, import.limit};
  const bool is_map = import.map != nullptr;
  const std::shared_ptr<const ObjectSource> source =
      is_map ? make_map_source(std::move(import.map), std::move(import.report), options,
                               import.map_origin_m)
             : make_source(ObjectKind::kMesh, std::move(*import.mesh), std::move(import.report),
                           options);
  SnapshotResult result = build(std::move(name), source, options, stop);
  // The file may have changed between the computation of the key and the import.
  if (result.snapshot && key && scene_key(file, preparation) == key) {
    cache->store(*key, file, prepared_of(*result.snapshot->objects.front()));
  }
  return named_after(file, std::move(result));
}

}  // namespace camway::scene
