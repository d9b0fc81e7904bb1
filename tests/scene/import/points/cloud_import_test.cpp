// SPDX-License-Identifier: MIT
//
// Files of points through the import process, up to scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "daemon/scene/import/import.h"
#include "daemon/scene/snapshot/scene_change.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/scene/import/points/point_files.h"
#include "tests/support/random.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

using camway::testing::Random;
using camway::testing::TemporaryFolder;
using geometry::Vec3;
using point_files::PcdEncoding;
using point_files::PointList;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr std::uint64_t kCloudFileSeed = 20261126;

/// Writes bytes, which `TemporaryFolder::write` would take for a text.
std::string write(const TemporaryFolder& folder, const std::string& name,
                  const std::string& bytes) {
  std::ofstream(folder.path() / name, std::ios::binary) << bytes;
  return (folder.path() / name).string();
}

SnapshotResult loaded(const std::string& file, const ImportOptions& import,
                      std::optional<double> occupancy_m = {}) {
  SnapshotOptions options;
  options.import = import;
  options.occupancy_resolution_m = occupancy_m;
  return load_snapshot("cloud", file, options);
}

Vec3 in_scene(const std::array<double, 3>& p, const ImportOptions& options) {
  const Vec3 at = options.scale * Vec3(p[0], p[1], p[2]);
  if (options.up == UpAxis::kZToY) return {at.x(), at.z(), -at.y()};
  if (options.up == UpAxis::kYToZ) return {at.x(), -at.z(), at.y()};
  return at;
}

/// Whether one of the boxes of the map's voxels, as placed in the world, contains the point.
bool is_in_a_voxel(const PlacedVoxelMap& solid, const Vec3& point) {
  bool is_in = false;
  solid.map->occupied().for_each([&](const Voxel& voxel) {
    const double edge_m = solid.map->resolution_m();
    const Vec3 low =
        solid.placement.to_world(Vec3(voxel[0] * edge_m, voxel[1] * edge_m, voxel[2] * edge_m));
    const Vec3 high = solid.placement.to_world(
        Vec3((voxel[0] + 1) * edge_m, (voxel[1] + 1) * edge_m, (voxel[2] + 1) * edge_m));
    is_in =
        is_in || ((low.array() <= point.array()).all() && (point.array() <= high.array()).all());
  });
  return is_in;
}

TEST(CloudImport, HoldsEachPointScaledAndTurned) {
  Random random(kCloudFileSeed);
  const TemporaryFolder folder;
  for (int trial = 0; trial < 12; ++trial) {
    ImportOptions import;
    import.scale = trial % 3 == 0 ? 1.0 : 0.3048;
    import.up = trial % 4 < 2 ? UpAxis::kAsInFile : trial % 4 == 2 ? UpAxis::kZToY : UpAxis::kYToZ;
    if (trial % 2 == 0) import.voxel_m = random.log_uniform(0.05, 2.0);
    const std::array<double, 3> middle{trial < 6 ? 0.0 : 635'619.85, trial < 6 ? 1.0 : -848'899.7,
                                       4};
    const PointList points = point_files::random_points(random, 150, 20.0, middle);
    const std::string file = write(folder, "a.xyz", point_files::write_xyz(points));
    const SnapshotResult scene = loaded(file, import);
    ASSERT_TRUE(scene.snapshot) << scene.error;
    const SceneObject& object = *scene.snapshot->objects[0];
    EXPECT_EQ(object.source->kind, ObjectKind::kMap);
    EXPECT_TRUE(object.placement.is_identity());
    EXPECT_LE(object.source->map_O->occupied().size(), points.size());
    for (const auto& point : points) {
      EXPECT_TRUE(is_in_a_voxel(*object.solid(), in_scene(point, import)));
      EXPECT_TRUE(scene.snapshot->solids->hold(in_scene(point, import)));
    }
    if (import.voxel_m) {
      EXPECT_EQ(object.source->map_O->resolution_m(), *import.voxel_m);
    }
    // The space between two points that are far from all others is free.
    EXPECT_FALSE(scene.snapshot->solids->hold(in_scene(middle, import) + Vec3(50.0, 0.0, 0.0)));
  }
}

TEST(CloudImport, IsTheSameFromEveryFormat) {
  Random random(kCloudFileSeed);
  const TemporaryFolder folder;
  for (const double far : {0.0, 500'000.0}) {
    const PointList points = point_files::random_points(random, 300, 5.0, {far, 0.0, -far});
    std::set<std::string> digests;
    int files = 0;
    const auto take = [&](const std::string& extension, const std::string& bytes) {
      const std::string file = write(folder, std::to_string(++files) + extension, bytes);
      const SnapshotResult scene = loaded(file, {});
      ASSERT_TRUE(scene.snapshot) << scene.error;
      digests.insert(scene.snapshot->digest);
    };
    for (const auto encoding :
         {PcdEncoding::kText, PcdEncoding::kBinary, PcdEncoding::kCompressed}) {
      take(".pcd", point_files::write_pcd(points, encoding, {'F', 8}, &random));
    }
    take(".xyz", point_files::write_xyz(points));
    take(".XYZ", point_files::write_xyz(points, ", ", "x,y,z\n"));
    take(".las", point_files::write_las(points, {.offset = {far, 0.0, -far}}));
    take(".las",
         point_files::write_las(points, {.minor_version = 4, .format = 6, .offset = {far}}));
    EXPECT_EQ(digests.size(), 1U);
  }
}

TEST(CloudImport, ChoosesVoxelsAndSaysSo) {
  const TemporaryFolder folder;
  PointList wall;
  for (int i = 0; i < 50; ++i) {
    for (int k = 0; k < 50; ++k) wall.push_back({0.01 * i, 0.01 * k, 1.0});
  }
  const std::string file = folder.write("wall.xyz", point_files::write_xyz(wall));
  const ImportResult chosen = import_mesh(file, {});
  ASSERT_TRUE(chosen.map) << chosen.error;
  EXPECT_EQ(chosen.map->resolution_m(), 0.02);
  EXPECT_THAT(chosen.report.notes,
              Contains("voxels of 0.02 m, about twice the median distance of neighbouring points: "
                       "say voxel_m to choose"));
  EXPECT_THAT(chosen.report.notes, Contains(HasSubstr("2500 points in ")));
  const ImportResult asked = import_mesh(file, {.voxel_m = 0.02});
  ASSERT_TRUE(asked.map);
  EXPECT_EQ(asked.map->occupied().size(), chosen.map->occupied().size());
  EXPECT_THAT(asked.report.notes, ::testing::Not(Contains(HasSubstr("say voxel_m"))));
}

TEST(CloudImport, ChoosesVoxelsWithinTheLimits) {
  Random random(kCloudFileSeed);
  const TemporaryFolder folder;
  const std::string file =
      folder.write("a.xyz", point_files::write_xyz(point_files::random_points(random, 2000, 5.0)));
  for (const VoxelMapLimits limits :
       {VoxelMapLimits{.voxels = 100}, VoxelMapLimits{.triangles = 500}}) {
    const ImportResult chosen = import_mesh(file, {.map_limits = limits});
    ASSERT_TRUE(chosen.map) << chosen.error;
    EXPECT_LE(chosen.map->occupied().size(), limits.voxels);
    EXPECT_LE(chosen.report.triangles, limits.triangles);
    EXPECT_THAT(chosen.report.notes, Contains(HasSubstr("as small as the limits")));
    const ImportResult asked = import_mesh(file, {.voxel_m = 0.1, .map_limits = limits});
    EXPECT_THAT(asked.error, HasSubstr("with voxels of 0.1 m: say a larger voxel_m"));
    EXPECT_NE(asked.limit, Limit::kNone);
  }
}

TEST(CloudImport, LeavesOutAndCountsWhatIsNotFinite) {
  const TemporaryFolder folder;
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 3\nDATA ascii\n";
  const ImportResult some =
      import_mesh(folder.write("a.pcd", head + "nan nan nan\n1 2 3\n0 inf 0\n"), {});
  ASSERT_TRUE(some.map) << some.error;
  EXPECT_EQ(some.map->occupied().size(), 1U);
  EXPECT_THAT(some.report.notes, Contains("2 points without finite coordinates are left out"));
  EXPECT_THAT(import_mesh(folder.write("b.pcd", head + "nan 0 0\nnan 1 1\nnan 2 2\n"), {}).error,
              HasSubstr("holds no point with finite coordinates"));
}

TEST(CloudImport, RefusesWhatItCannotDoInWords) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text, const ImportOptions& options) {
    return import_mesh(folder.write("a.xyz", text), options).error;
  };
  EXPECT_THAT(error("0 0 0\n4000 0 0\n", {.voxel_m = 0.01}),
              HasSubstr("its points are 4000 m apart along x (0 to 4000 m), which is more than "
                        "65531 voxels of 0.01 m: voxel_m must be 0.0611 at least"));
  EXPECT_THAT(error("0 0 0\n1 1 1\n", {.unknown = UnknownSpace::kOccupied}),
              HasSubstr("says nothing of free space"));
  EXPECT_THAT(error("0 0 0\n1e250 1 1\n", {}), HasSubstr("too far from the origin"));
  EXPECT_THAT(error("0 0 0\n1 1\n", {}), HasSubstr("line 2"));
}

TEST(CloudImport, IsPlacedAndScannedLikeOtherMaps) {
  Random random(kCloudFileSeed);
  const TemporaryFolder folder;
  const std::array<double, 3> middle{635'000.0, 10.0, 848'000.0};
  const PointList points = point_files::random_points(random, 100, 3.0, middle);
  const SnapshotResult scene =
      loaded(folder.write("a.xyz", point_files::write_xyz(points)), {.voxel_m = 0.1});
  ASSERT_TRUE(scene.snapshot) << scene.error;
  std::string fault;
  // A half turn about y through the origin, then back to where the cloud was.
  const Placement turn =
      Placement::make({1'270'000.0, 0.0, 1'696'000.0}, geometry::Quat(0.0, 0.0, 1.0, 0.0), fault);
  const SnapshotResult moved =
      changed(*scene.snapshot, SceneChange{SceneChange::Kind::kMove, "cloud", nullptr, turn}, 2);
  ASSERT_TRUE(moved.snapshot) << moved.error;
  EXPECT_TRUE(moved.snapshot->objects[0]->placement == turn);
  for (const auto& point : points) {
    const Vec3 turned = turn.to_world(Vec3(point[0], point[1], point[2]));
    EXPECT_TRUE(moved.snapshot->solids->hold(turned));
    EXPECT_TRUE(moved.snapshot->objects[0]->bounds_W.contains(turned));
  }
  const SnapshotResult back =
      changed(*moved.snapshot, SceneChange{SceneChange::Kind::kMove, "cloud", nullptr, {}}, 3);
  EXPECT_EQ(back.snapshot->digest, scene.snapshot->digest);
}

TEST(CloudImport, IsMirroredAsItIs) {
  Random random(kCloudFileSeed);
  const TemporaryFolder folder;
  const PointList points = point_files::random_points(random, 100, 3.0);
  const SnapshotResult scene =
      loaded(folder.write("a.xyz", point_files::write_xyz(points)), {.voxel_m = 0.25}, 0.25);
  ASSERT_TRUE(scene.snapshot) << scene.error;
  EXPECT_EQ(scene.snapshot->occupancy->statistics().occupied_voxels,
            scene.snapshot->objects[0]->source->map_O->occupied().size());
}

}  // namespace
}  // namespace camway::scene
