// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "daemon/scene/log/source_record.h"
#include "daemon/scene/snapshot/scene_object.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/scene/voxels/map_scan.h"
#include "tests/support/random.h"

/// Contents of scene objects, for tests of their records.
namespace camway::scene {

using SourcePtr = std::shared_ptr<const ObjectSource>;

/// Returns options without a field, which takes most of the time.
inline ObjectOptions without_field() {
  ObjectOptions options;
  options.field.reset();
  return options;
}

/// Returns a report of which each number differs from its default.
inline ImportReport random_report(testing::Random& random) {
  ImportReport report;
  report.format = "format " + std::to_string(random() % 1000);
  report.scale = random.log_uniform(1e-3, 1e3);
  report.up = static_cast<UpAxis>(random.integer(0, 2));
  for (std::uint64_t* const count :
       {&report.vertices, &report.triangles, &report.objects, &report.degenerate_triangles,
        &report.dropped_nonfinite, &report.dropped_bad_index, &report.dropped_points_and_lines,
        &report.dropped_freeform, &report.ignored_statements}) {
    *count = random() | 1U;
  }
  if (random.chance(0.8)) {
    report.bounds_m.extend(random.in_cube(9.0));
    report.bounds_m.extend(random.in_cube(9.0));
  }
  report.single_precision = random.chance(0.5);
  report.rounding_m = random.log_uniform(1e-18, 1e-3);
  if (random.chance(0.5)) report.surface_error_m = random.log_uniform(1e-18, 1e-3);
  return report;
}

/// Returns a mesh of several objects. Its vertices have all magnitudes, and some are shared.
inline Mesh mesh_of_objects(testing::Random& random, int objects, double largest_m) {
  Mesh mesh;
  for (int i = 0; i < 3 * objects + 4; ++i) {
    mesh.vertices.push_back(random.log_uniform(1e-300, largest_m) * random.in_cube(1.0));
  }
  mesh.vertices.emplace_back(-0.0, 0.0, std::numeric_limits<double>::denorm_min());
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  for (int object = 0; object < objects; ++object) {
    const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
    for (int i = random.integer(1, 5); i-- > 0;) {
      const auto at = static_cast<std::uint32_t>(random.integer(0, last - 2));
      mesh.triangles.push_back({at, at + 2, at + 1});
    }
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size()) - first;
    mesh.objects.push_back({std::string(static_cast<std::size_t>(object), 'n'), first, count});
  }
  return mesh;
}

/// Returns the meshes of all shapes, among them one whose triangles lost their area and one without
/// triangles.
inline std::vector<SourcePtr> shape_samples(testing::Random& random) {
  std::vector<SourcePtr> sources;
  const auto take = [&](ObjectKind kind, base::Result<Mesh> mesh) {
    ASSERT_TRUE(mesh) << mesh.error;
    const ImportReport report = report_of(*mesh, to_string(kind));
    sources.push_back(make_source(kind, *std::move(mesh), report, without_field()));
  };
  const double least = std::numeric_limits<double>::denorm_min();
  take(ObjectKind::kBox, box_mesh({1.0, random.uniform(0.1, 2.0), 1.0 / 3.0}));
  take(ObjectKind::kBox, box_mesh({1.0, least, 1.0}));
  take(ObjectKind::kSphere, sphere_mesh(random.uniform(0.1, 3.0), 0.01));
  take(ObjectKind::kCylinder, cylinder_mesh(random.uniform(0.1, 3.0), 2.0, 0.01));
  take(ObjectKind::kCylinder, cylinder_mesh(least, 1.0, 1.0));
  std::vector<geometry::Vec3> points;
  take(ObjectKind::kPointCloud, cloud_mesh(points, 0.1));
  for (int i = 0; i < 40; ++i) points.push_back(random.in_cube(0.5));
  take(ObjectKind::kPointCloud, cloud_mesh(points, 0.1));
  return sources;
}

constexpr double kSampleVoxel_m = 0.1;

/// Returns a map as from a file: without beliefs, and with voxels that are in both sets.
inline std::shared_ptr<const VoxelMap> map_sample(testing::Random& random, UnknownSpace unknown,
                                                  int voxels, const SensorModel& sensor = {}) {
  VoxelSet occupied;
  VoxelSet free;
  for (int i = 0; i < voxels; ++i) {
    Voxel voxel{};
    for (std::int32_t& at : voxel) at = random.integer(-20, 20);
    if (random.chance(0.4)) occupied.insert(voxel);
    if (random.chance(0.7)) free.insert(voxel);
  }
  return VoxelMap::build(kSampleVoxel_m, occupied, free, unknown, {}, sensor).map;
}

/// Returns the map after a scan of `points` rays up to `reach_m`, which may empty blocks.
inline std::shared_ptr<const VoxelMap> scanned_sample(testing::Random& random, const VoxelMap& map,
                                                      int points, double reach_m) {
  const geometry::Vec3 origin = random.in_cube(1.0);
  std::vector<geometry::Vec3> seen;
  for (int i = 0; i < points; ++i) {
    seen.push_back(origin + random.uniform(0.2, reach_m) * random.direction());
  }
  const VoxelMapResult result = scanned(map, {origin, seen});
  EXPECT_TRUE(result.map) << result.error;
  return result.map;
}

inline SourcePtr source_of_map(std::shared_ptr<const VoxelMap> map,
                               const geometry::Vec3& origin = geometry::Vec3::Zero()) {
  const ImportReport report = report_of(*map, "OctoMap");
  return make_map_source(std::move(map), report, without_field(), origin);
}

/// Returns a series of maps, each after one scan of the map before; the later scans are small.
inline std::vector<SourcePtr> scanned_samples(testing::Random& random, UnknownSpace unknown) {
  SensorModel sensor;
  if (random.chance(0.5)) sensor = {0.8, 0.3, 0.05, 0.9, 2.5};
  // Most maps begin where their object does.
  const geometry::Vec3 origin =
      random.chance(0.4) ? random.in_cube(1e6) : geometry::Vec3(geometry::Vec3::Zero());
  std::vector<SourcePtr> sources{source_of_map(map_sample(random, unknown, 300, sensor), origin)};
  for (int i = 0; i < 10; ++i) {
    const VoxelMap& before = *sources.back()->map_O;
    sources.push_back(source_of_map(
        i < 3 ? scanned_sample(random, before, 200, 3.0) : scanned_sample(random, before, 3, 1.0),
        origin));
  }
  return sources;
}

/// Returns the source of a record that has to be readable.
inline SourcePtr decoded(const Bytes& record, const SourcePtr& base = nullptr) {
  base::Result<SourcePtr> result = source_from(record, base, without_field());
  EXPECT_TRUE(result) << result.error;
  return result ? *result : nullptr;
}

/// Returns why a record is refused, or an empty text.
inline std::string error_of(const Bytes& record, const SourcePtr& base = nullptr) {
  return source_from(record, base, without_field()).error;
}

}  // namespace camway::scene
