// SPDX-License-Identifier: MIT
//
// Scenes in which a map is scanned repeatedly, compared with scenes that are made from scratch.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <sstream>
#include <vector>

#include "daemon/scene/snapshot/scene_change.h"
#include "daemon/scene/snapshot/scene_difference.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/scene/voxels/map_scan.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Quat;
using geometry::Triangle;
using geometry::Vec3;

constexpr double kScanResolution_m = 0.1;

struct Case {
  UnknownSpace unknown = UnknownSpace::kFree;
  Placement placement;
  ObjectOptions options;
};

std::vector<Case> cases(testing::Random& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::string fault;
  const Placement elsewhere =
      Placement::make({3.0, -2.0, 1.0}, Quat(1.0, unit(random), unit(random), unit(random)), fault);
  std::vector<Case> all;
  for (const UnknownSpace unknown : {UnknownSpace::kFree, UnknownSpace::kOccupied}) {
    all.push_back({unknown, {}, {}});
    all.back().options.occupancy_resolution_m = kScanResolution_m;
    all.push_back({unknown, {}, {}});
    all.back().options.occupancy_resolution_m = 0.25;
    all.push_back({unknown, elsewhere, {}});
  }
  return all;
}

/// Returns the scan of a sensor there: walls of rooms of 3 m, and rays without a return.
std::vector<Vec3> sight_in_room(testing::Random& random, const Vec3& origin) {
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int i = 0; i < 60; ++i) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    double way_m = i % 7 == 0 ? 5.0 : std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double wall_m = (std::floor(origin[k] / 3.0) + (direction[k] > 0.0 ? 1.0 : 0.0)) * 3.0;
      way_m = std::min(way_m, (wall_m - origin[k]) / direction[k]);
    }
    points.push_back(origin + way_m * direction);
  }
  return points;
}

/// Returns a map with the same voxels that shares nothing with `map`.
std::shared_ptr<const VoxelMap> anew(const VoxelMap& map) {
  VoxelSet occupied;
  VoxelSet free;
  map.occupied().for_each([&](const Voxel& voxel) { occupied.insert(voxel); });
  map.free().for_each([&](const Voxel& voxel) { free.insert(voxel); });
  return VoxelMap::build(map.resolution_m(), std::move(occupied), std::move(free), map.unknown(),
                         map.limits(), map.sensor())
      .map;
}

SceneChange put(std::shared_ptr<const VoxelMap> map, const Case& at) {
  const ImportReport report = report_of(*map, "OctoMap");
  return {SceneChange::Kind::kPut, "map",
          make_map_source(std::move(map), report, at.options, geometry::Vec3::Zero()),
          at.placement};
}

std::shared_ptr<const Snapshot> after(const std::shared_ptr<const Snapshot>& scene,
                                      const SceneChange& change) {
  const SnapshotResult result = changed(*scene, change, scene->revision + 1);
  EXPECT_TRUE(result.snapshot) << result.error;
  return result.snapshot;
}

/// Returns a scene with one object before the map and one after it.
std::shared_ptr<const Snapshot> empty_scene(const Case& at) {
  auto scene = assemble("room", 1, {}, at.options);
  std::string fault;
  for (const std::string name : {"box", "wall"}) {
    Mesh mesh = *box_mesh(Vec3(0.3, 0.4, 0.5));
    const ImportReport report = report_of(mesh, "box");
    const auto source = make_source(ObjectKind::kBox, std::move(mesh), report, at.options);
    const double at_m = name == "box" ? 1.0 : -1.0;
    scene = after(scene, {SceneChange::Kind::kPut, name, source,
                          Placement::make(Vec3::Constant(at_m), Quat::Identity(), fault)});
  }
  return scene;
}

std::string exported(const Snapshot& scene) {
  std::ostringstream out;
  if (scene.occupancy) scene.occupancy->write_bt(out);
  return out.str();
}

void expect_equal_answers(const Snapshot& a, const Snapshot& b, testing::Random& random) {
  ASSERT_EQ(a.digest, b.digest);
  ASSERT_TRUE(a.index.has_same_trees_as(b.index));
  ASSERT_EQ(a.index.statistics(), b.index.statistics());
  ASSERT_EQ(a.mesh->vertices, b.mesh->vertices);
  ASSERT_EQ(a.mesh->triangles, b.mesh->triangles);
  ASSERT_EQ(a.report.vertices, b.report.vertices);
  ASSERT_EQ(a.report.triangles, b.report.triangles);
  ASSERT_EQ(a.why_no_field, b.why_no_field);
  ASSERT_EQ(exported(a), exported(b));
  const Box box = a.index.bounds();
  std::uniform_real_distribution<double> unit(-0.1, 1.1);
  for (int i = 0; i < 100; ++i) {
    const Vec3 at =
        box.min() + Vec3(unit(random), unit(random), unit(random)).cwiseProduct(box.sizes());
    const std::array<Triangle, 1> body{{{at, at + Vec3(0.1, 0, 0), at + Vec3(0, 0.2, 0.1)}}};
    const double none = std::numeric_limits<double>::infinity();
    ASSERT_EQ(a.index.nearest(body, none)->distance_m, b.index.nearest(body, none)->distance_m);
    ASSERT_EQ(a.index.nearest(body, none)->triangle, b.index.nearest(body, none)->triangle);
    ASSERT_EQ(a.index.any_within(body, 0.2).has_value(), b.index.any_within(body, 0.2).has_value());
    ASSERT_EQ(a.solids->hold(at), b.solids->hold(at));
    if (!a.occupancy) continue;
    ASSERT_EQ(a.occupancy->occupied_at(at), b.occupancy->occupied_at(at));
    ASSERT_EQ(a.occupancy->distance_m(at, none), b.occupancy->distance_m(at, none));
  }
  if (!a.occupancy) return;
  ASSERT_EQ(a.occupancy->statistics().occupied_voxels, b.occupancy->statistics().occupied_voxels);
  ASSERT_EQ(a.occupancy->statistics().nodes, b.occupancy->statistics().nodes);
}

/// Expects that unchanged parts are shared, and that no others are said to be.
void expect_shared(const SceneObject& before, const SceneObject& now) {
  for (std::size_t i = 0; i < now.parts.size(); ++i) {
    const MeshPart& part = now.source->parts_O[i];
    const auto old = std::ranges::find(before.source->parts_O, part.key, &MeshPart::key);
    const bool is_equal = old != before.source->parts_O.end() &&
                          old->mesh->vertices == part.mesh->vertices &&
                          old->mesh->triangles == part.mesh->triangles;
    if (!is_equal) continue;
    ASSERT_EQ(old->mesh, part.mesh);
    const auto at = static_cast<std::size_t>(old - before.source->parts_O.begin());
    ASSERT_EQ(before.parts[at], now.parts[i]);
  }
}

bool any_holds(const std::vector<Box>& boxes, const Vec3& point) {
  return std::ranges::any_of(boxes, [&](const Box& box) { return box.contains(point); });
}

/// Expects that a voxel that became solid is in an added box, and one that is solid no more in a
/// removed one.
void expect_told(const Snapshot& before, const Snapshot& now) {
  const SceneDifference difference = scene::difference(before, now);
  const SceneObject& old_object = *before.find("map");
  const SceneObject& object = *now.find("map");
  const VoxelSet& old_solid = old_object.source->map_O->solid();
  const VoxelSet& solid = object.source->map_O->solid();
  const auto middle = [&](const Voxel& voxel) {
    const Vec3 at_O(voxel[0] + 0.5, voxel[1] + 0.5, voxel[2] + 0.5);
    return object.placement.to_world(kScanResolution_m * at_O);
  };
  bool has_come = false;
  solid.for_each([&](const Voxel& voxel) {
    if (old_solid.contains(voxel)) return;
    has_come = true;
    ASSERT_TRUE(any_holds(difference.added, middle(voxel)));
  });
  old_solid.for_each([&](const Voxel& voxel) {
    if (!solid.contains(voxel)) {
      ASSERT_TRUE(any_holds(difference.removed, middle(voxel)));
    }
  });
  ASSERT_EQ(difference.solids != nullptr, has_come);
  std::size_t triangles = 0;
  for (const auto& part : object.parts) {
    const bool is_new = std::ranges::find(old_object.parts, part) == old_object.parts.end();
    if (is_new) triangles += part->indexed->mesh->triangles.size();
  }
  ASSERT_EQ(difference.index.size(), triangles);
}

TEST(ScannedScene, IsTheSceneThatIsMadeAnewOfTheSameVoxels) {
  testing::Random random(77401);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::size_t shared = 0;
  for (const Case& at : cases(random)) {
    SensorModel sensor;
    sensor.max_range_m = 2.0;
    auto map = VoxelMap::build(kScanResolution_m, {}, {}, at.unknown, {}, sensor).map;
    std::shared_ptr<const Snapshot> scene = after(empty_scene(at), put(map, at));
    for (int scan = 0; scan < 6; ++scan) {
      const Vec3 origin = 2.0 * Vec3(unit(random), unit(random), unit(random));
      const VoxelMapResult next = scanned(*map, {origin, sight_in_room(random, origin)});
      ASSERT_TRUE(next.map) << next.error;
      const std::shared_ptr<const Snapshot> now = after(scene, put(next.map, at));
      const std::shared_ptr<const Snapshot> other =
          after(empty_scene(at), put(anew(*next.map), at));
      ASSERT_NO_FATAL_FAILURE(expect_equal_answers(*now, *other, random));
      ASSERT_NO_FATAL_FAILURE(expect_shared(*scene->find("map"), *now->find("map")));
      ASSERT_NO_FATAL_FAILURE(expect_told(*scene, *now));
      for (const auto& part : now->find("map")->parts) {
        shared += static_cast<std::size_t>(std::ranges::count(scene->find("map")->parts, part));
      }
      map = next.map;
      scene = now;
    }
  }
  EXPECT_GT(shared, 100U);
}

/// Revisions that are restored have the mirror and the trees that they had.
TEST(ScannedScene, CanBeBuiltAgain) {
  testing::Random random(77402);
  const Case at = cases(random).front();
  auto map = VoxelMap::build(kScanResolution_m, {}, {}, at.unknown).map;
  std::shared_ptr<const Snapshot> scene = after(empty_scene(at), put(map, at));
  SceneHistory history(*scene, {});
  std::vector<std::shared_ptr<const Snapshot>> revisions;
  for (int scan = 0; scan < 4; ++scan) {
    map = scanned(*map, {Vec3::Constant(0.5), sight_in_room(random, Vec3::Constant(0.5))}).map;
    const SceneChange change = put(map, at);
    scene = after(scene, change);
    history.add({change}, {scene->revision, {}});
    revisions.push_back(scene);
  }
  for (const auto& revision : revisions) {
    const auto again = history.rebuild(revision->revision);
    ASSERT_TRUE(again);
    ASSERT_NO_FATAL_FAILURE(expect_equal_answers(*revision, *again, random));
  }
}

}  // namespace
}  // namespace camway::scene
