// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/snapshot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tests/geometry/random_triangles.h"
#include "tests/scene/test_meshes.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;
using geometry::Triangle;
using geometry::Vec3;
using ::testing::HasSubstr;

const Triangle kTriangle = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
const Triangle kOther = {Vec3(0, 0, 5), Vec3(1, 0, 5), Vec3(0, 1, 5)};

TEST(MeshDigest, IsOfTheTrianglesNotOfTheirStorage) {
  const Mesh separate = mesh_of_triangles({kTriangle, kOther});
  Mesh shared;
  shared.vertices = {kOther[0], kOther[1], kOther[2], kTriangle[0], kTriangle[1], kTriangle[2]};
  shared.triangles = {{3, 4, 5}, {0, 1, 2}};
  EXPECT_EQ(mesh_digest(separate), mesh_digest(shared));
  EXPECT_THAT(mesh_digest(separate), ::testing::MatchesRegex("[0-9a-f]{32}"));
}

TEST(MeshDigest, TellsEveryChangeApart) {
  const std::string digest = mesh_digest(mesh_of_triangles({kTriangle, kOther}));
  EXPECT_NE(mesh_digest(mesh_of_triangles({kOther, kTriangle})), digest);
  EXPECT_NE(mesh_digest(mesh_of_triangles({kTriangle})), digest);
  EXPECT_NE(mesh_digest(Mesh()), digest);
  for (std::size_t i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      Triangle changed = kTriangle;
      changed[i][k] = std::nextafter(changed[i][k], 2.0);
      EXPECT_NE(mesh_digest(mesh_of_triangles({changed, kOther})), digest);
    }
  }
}

TEST(MeshDigest, DoesNotDependOnTheMachineOrTheRun) {
  // A wire value, which must not change between versions without notice.
  EXPECT_EQ(mesh_digest(mesh_of_triangles({kTriangle})), "39d6a5811dcd0c65d11d527e58c0d8a7");
  Triangle negative_zero = kTriangle;
  negative_zero[0].x() = -0.0;
  EXPECT_EQ(mesh_digest(mesh_of_triangles({negative_zero})),
            mesh_digest(mesh_of_triangles({kTriangle})));
}

TEST(MakeSnapshot, HoldsMeshTreeAndReport) {
  const SnapshotResult result = make_snapshot("room", mesh_of_triangles({kTriangle, kOther}));
  ASSERT_TRUE(result.snapshot) << result.error;
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(result.snapshot->name, "room");
  EXPECT_EQ(result.snapshot->index.size(), 2U);
  EXPECT_EQ(result.snapshot->mesh->triangles.size(), 2U);
  EXPECT_EQ(result.snapshot->digest, mesh_digest(*result.snapshot->mesh));
  EXPECT_EQ(result.snapshot->report.triangles, 2U);
  EXPECT_EQ(result.snapshot->report.bounds_m.max(), Vec3(1, 1, 5));
  EXPECT_FALSE(result.snapshot->occupancy);
}

TEST(MakeSnapshot, HoldsADistanceFieldOrTheReasonWhyNot) {
  const Mesh mesh = mesh_of_triangles({kTriangle, kOther});
  const SnapshotResult with = make_snapshot("room", mesh);
  ASSERT_TRUE(with.snapshot->field) << with.snapshot->why_no_field;
  EXPECT_EQ(with.snapshot->why_no_field, "");
  EXPECT_GT(with.snapshot->field->clearance_at_least_m(Vec3(0.5, 0.5, 2.5)), 1.0);

  const SnapshotResult empty = make_snapshot("nothing", Mesh());
  EXPECT_FALSE(empty.snapshot->field);
  EXPECT_THAT(empty.snapshot->why_no_field, HasSubstr("no triangles"));

  SnapshotOptions options;
  options.field.reset();
  const SnapshotResult without = make_snapshot("room", mesh, options);
  EXPECT_FALSE(without.snapshot->field);
  EXPECT_THAT(without.snapshot->why_no_field, HasSubstr("not asked for"));

  options.field = DistanceFieldOptions{.memory_limit_bytes = 4096, .threads = 1};
  const SnapshotResult small = make_snapshot("room", mesh, options);
  ASSERT_TRUE(small.snapshot->field);
  EXPECT_LE(small.snapshot->field->statistics().memory_bytes, 4096U);
}

TEST(MakeSnapshot, MirrorsIntoOctoMapIfAResolutionIsGiven) {
  SnapshotOptions options;
  options.occupancy_resolution_m = 0.25;
  const SnapshotResult result = make_snapshot("room", mesh_of_triangles({kTriangle}), options);
  ASSERT_TRUE(result.snapshot) << result.error;
  ASSERT_TRUE(result.snapshot->occupancy);
  EXPECT_EQ(result.snapshot->occupancy->resolution_m(), 0.25);
  EXPECT_TRUE(result.snapshot->occupancy->occupied_at(Vec3(0.2, 0.2, 0.0)));
}

TEST(MakeSnapshot, SaysWhichSceneCannotBeMirrored) {
  SnapshotOptions options;
  options.occupancy_resolution_m = 1e-6;
  const SnapshotResult result =
      make_snapshot("room", mesh_of_triangles({kTriangle, kOther}), options);
  EXPECT_FALSE(result.snapshot);
  EXPECT_THAT(result.error, HasSubstr("room"));
}

TEST(LoadSnapshot, ReadsAFileOrNamesIt) {
  const fs::path file =
      fs::path(::testing::TempDir()) / ("camway_snapshot_" + std::to_string(getpid()) + ".off");
  std::ofstream(file) << "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  SnapshotOptions options;
  options.import.scale = 2.0;
  const SnapshotResult result = load_snapshot("room", file, options);
  ASSERT_TRUE(result.snapshot) << result.error;
  EXPECT_EQ(result.snapshot->report.bounds_m.max(), Vec3(2, 2, 0));
  EXPECT_THAT(result.snapshot->report.format, HasSubstr("OFF"));
  options.occupancy_resolution_m = 1e-7;
  EXPECT_THAT(load_snapshot("room", file, options).error, HasSubstr(file.string()));
  fs::remove(file);
  EXPECT_THAT(load_snapshot("room", file).error, HasSubstr(file.string()));
}

}  // namespace
}  // namespace camway::scene
