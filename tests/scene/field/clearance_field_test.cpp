// SPDX-License-Identifier: MIT
#include "daemon/scene/field/clearance_field.h"

#include <gtest/gtest.h>

#include <limits>

#include "daemon/scene/snapshot/scene_change.h"
#include "tests/scene/index/index_oracle.h"
#include "tests/scene/test_meshes.h"

namespace camway::scene {
namespace {

using geometry::Quat;
using geometry::RandomTriangles;
using geometry::Triangle;
using geometry::Vec3;

/// Returns a scene of objects at random poses, at this distance from the origin.
std::shared_ptr<const Snapshot> random_scene(RandomTriangles& random, int count, double away_m) {
  ObjectOptions options;
  SceneObjects objects;
  for (int i = 0; i < count; ++i) {
    std::vector<Triangle> triangles;
    for (int k = 0; k < 20; ++k) {
      const Vec3 at = random.in_cube(1.0);
      triangles.push_back({at + random.in_cube(0.2), at + random.in_cube(0.2), at});
    }
    Mesh mesh = mesh_of_triangles(triangles);
    std::string fault;
    const Placement placement = Placement::make(
        Vec3(away_m, 0, 0) + random.in_cube(6.0),
        Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 0.5), fault);
    const ImportReport report = report_of(mesh, "test");
    objects.push_back(place_object("o" + std::to_string(100 + i),
                                   make_source(ObjectKind::kMesh, std::move(mesh), report, options),
                                   i % 4 == 3 ? Placement() : placement, options)
                          .object);
  }
  return assemble("random", 1, std::move(objects), options);
}

TEST(ClearanceField, IsNeverMoreThanTheDistanceToAnyObject) {
  RandomTriangles random(1201);
  int useful = 0;
  int asked = 0;
  for (const double away_m : {0.0, 1e3, 1e7}) {
    for (int round = 0; round < 10; ++round) {
      const auto scene = random_scene(random, 1 + round, away_m);
      ASSERT_TRUE(scene->field) << scene->why_no_field;
      for (int i = 0; i < 400; ++i) {
        const Vec3 point = Vec3(away_m, 0, 0) + random.in_cube(i % 2 == 0 ? 8.0 : 1.5);
        const std::array<Triangle, 1> body = {Triangle{point, point, point}};
        const double true_m = scene->index.nearest(body, kInfinity)->distance_m;
        const double bound_m = scene->field->clearance_at_least_m(point);
        ASSERT_LE(bound_m, true_m + scene->index.nearest_error_m(body));
        ++asked;
        useful += bound_m > 0.5 * true_m ? 1 : 0;
      }
    }
  }
  EXPECT_GT(useful, asked / 2) << "a bound that says nothing is no use";
}

// A rounding that is missing in the bound would cause an error of half a micrometre at this
// distance.
TEST(ClearanceField, HoldsWhereRoundingIsAllThatThereIs) {
  RandomTriangles random(1202);
  ObjectOptions options;
  const double far_m = 5e8;
  const Mesh mesh = mesh_of_triangles({{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)}});
  const auto source = make_source(ObjectKind::kMesh, mesh, report_of(mesh, "test"), options);
  ASSERT_TRUE(source->field_O);
  for (int i = 0; i < 300; ++i) {
    std::string fault;
    const Placement placement = Placement::make(
        Vec3(far_m, -far_m, far_m),
        Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 0.5), fault);
    const auto scene =
        assemble("far", 1, {place_object("o", source, placement, options).object}, options);
    const Vec3 point = placement.to_world(Vec3(1, 1, random.uniform(1.0, 3.0)));
    const std::array<Triangle, 1> body = {Triangle{point, point, point}};
    const double true_m = scene->index.nearest(body, kInfinity)->distance_m;
    ASSERT_LE(scene->field->clearance_at_least_m(point), true_m);
  }
}

TEST(ClearanceField, KnowsNothingOfWhatIsNoPoint) {
  RandomTriangles random(1203);
  const auto scene = random_scene(random, 3, 0.0);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    EXPECT_EQ(scene->field->clearance_at_least_m(Vec3(0, bad, 0)), 0.0);
  }
}

TEST(ClearanceField, IsOffWithTooManyObjects) {
  RandomTriangles random(1204);
  const int most = static_cast<int>(ClearanceField::kMaxObjects);
  EXPECT_TRUE(random_scene(random, most, 0.0)->field);
  const auto more = random_scene(random, most + 1, 0.0);
  EXPECT_FALSE(more->field);
  EXPECT_NE(more->why_no_field, "");
}

}  // namespace
}  // namespace camway::scene
