// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot.h"

#include <xxhash.h>

#include <cstdio>
#include <utility>

namespace camway::scene {
namespace {

SnapshotResult build(std::string name, Mesh mesh, ImportReport report,
                     const SnapshotOptions& options) {
  auto snapshot = std::make_shared<Snapshot>();
  if (options.occupancy_resolution_m) {
    OccupancyMap::BuildResult mirror = OccupancyMap::build(mesh, *options.occupancy_resolution_m);
    if (!mirror.map) return {nullptr, name + ": " + mirror.error};
    snapshot->occupancy = std::move(mirror.map);
  }
  if (options.field) {
    DistanceFieldResult result = DistanceField::build(mesh, *options.field);
    snapshot->field = std::move(result.field);
    snapshot->why_no_field = std::move(result.why_off);
  } else {
    snapshot->why_no_field = "it was not asked for";
  }
  snapshot->name = std::move(name);
  snapshot->digest = mesh_digest(mesh);
  snapshot->mesh = std::make_shared<const Mesh>(std::move(mesh));
  snapshot->index = SceneIndex::build(snapshot->mesh, options.index);
  snapshot->report = std::move(report);
  return {std::move(snapshot), ""};
}

/// What an import would have reported of a mesh that is already there.
ImportReport report_of(const Mesh& mesh) {
  ImportReport report;
  report.format = "memory";
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  report.objects = mesh.objects.size();
  report.bounds_m = mesh.bounds();
  return report;
}

}  // namespace

std::string mesh_digest(const Mesh& mesh) {
  XXH3_state_t* state = XXH3_createState();
  XXH3_128bits_reset(state);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<double, 9> coordinates{};
    std::size_t at = 0;
    for (const geometry::Vec3& v : mesh.triangle(i)) {
      for (int k = 0; k < 3; ++k) coordinates[at++] = v[k] + 0.0;  // -0 is the same point as 0
    }
    XXH3_128bits_update(state, coordinates.data(), sizeof coordinates);
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(state);
  XXH3_freeState(state);
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return text;
}

SnapshotResult make_snapshot(std::string name, Mesh mesh, const SnapshotOptions& options) {
  ImportReport report = report_of(mesh);
  return build(std::move(name), std::move(mesh), std::move(report), options);
}

SnapshotResult load_snapshot(std::string name, const std::filesystem::path& file,
                             const SnapshotOptions& options) {
  ImportResult import = import_mesh(file, options.import);
  if (!import.mesh) return {nullptr, import.error};
  SnapshotResult result =
      build(std::move(name), std::move(*import.mesh), std::move(import.report), options);
  if (!result.snapshot) result.error = file.string() + ": " + result.error;
  return result;
}

}  // namespace camway::scene
