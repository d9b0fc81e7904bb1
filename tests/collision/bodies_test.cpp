// SPDX-License-Identifier: MIT
//
// Bodies other than the near quadrilateral, required clearance, and witnesses, on motions whose
// intervals are known in closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/collision/clearance.h"
#include "daemon/collision/detect.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::collision {
namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::Body;
using motion::Keyframe;
using motion::Path;
using scene::Mesh;
using scene::SceneIndex;

constexpr double kSpeed_m_per_s = 4.0;

// Returns a path from z = 2 to z = -2 in one second.
Path descent(const Quat& orientation) {
  return motion::interpolate(
      std::vector<Keyframe>{{0.0, {{0, 0, 2}, orientation}}, {1.0, {{0, 0, -2}, orientation}}});
}

Body make(const motion::BodyShape& shape) {
  base::Result<Body> body = Body::make(shape);
  EXPECT_TRUE(body) << body.error;
  return body.value.value_or(Body(testing::small_camera()));
}

SceneIndex large_plate() {
  Mesh mesh;
  testing::add_triangle(mesh, {-50, -50, 0}, {50, -50, 0}, {0, 80, 0});
  return SceneIndex::build(mesh);
}

std::vector<CollisionInterval> detect(const SceneIndex& index, const Path& path, const Body& body,
                                      double clearance_m = 0.0) {
  DetectOptions options;
  options.clearance_m = clearance_m;
  return detect_collisions({Obstacles(index), body, options}, path, path.begin_s(), path.end_s(),
                           base::Deadline::never())
      .value_or(std::vector<CollisionInterval>{{-1.0, -1.0}});
}

// Expects a collision while the lowest point of the body is below z = 0 and the highest above.
void expect_crossing(const std::vector<CollisionInterval>& found, double lowest_m,
                     double highest_m) {
  ASSERT_EQ(found.size(), 1u);
  const double begin_s = (2.0 + lowest_m) / kSpeed_m_per_s;
  const double end_s = (2.0 + highest_m) / kSpeed_m_per_s;
  const double bracket_s = 2.0 * DetectOptions{}.tolerance_m / kSpeed_m_per_s;
  EXPECT_LE(found[0].t_begin_s, begin_s);
  EXPECT_GE(found[0].t_end_s, end_s);
  EXPECT_NEAR(found[0].t_begin_s, begin_s, bracket_s);
  EXPECT_NEAR(found[0].t_end_s, end_s, bracket_s);
}

TEST(Bodies, CrossAPlateFromTheirLowestToTheirHighestPoint) {
  testing::Random random(51);
  const SceneIndex index = large_plate();
  const motion::BoxShape box{{0.1, -0.2, 0.05}, {0.3, 0.2, 0.6}};
  const motion::SphereShape ball{{0.1, 0.2, -0.3}, 0.25};
  const motion::ConvexShape pyramid{
      {{{0, 0, 0}, {0.2, 0.1, -0.4}, {-0.2, 0.1, -0.4}, {-0.2, -0.1, -0.4}, {0.2, -0.1, -0.4}}}};
  const motion::MeshShape fin{pyramid.pieces_C[0], {{0, 1, 2}, {0, 3, 4}}};
  for (int run = 0; run < 25; ++run) {
    const Quat orientation = random.rotation();
    const Path path = descent(orientation);
    const double center_m = (orientation * ball.center_C).z();
    expect_crossing(detect(index, path, make(ball)), center_m - ball.radius_m,
                    center_m + ball.radius_m);
    const double middle_m = (orientation * box.center_C).z();
    const double half_m =
        0.5 * (orientation.toRotationMatrix().row(2).cwiseAbs() * box.size_m).value();
    expect_crossing(detect(index, path, make(box)), middle_m - half_m, middle_m + half_m);
    double lowest_m = 1.0;
    double highest_m = -1.0;
    for (const Vec3& point : pyramid.pieces_C[0]) {
      lowest_m = std::min(lowest_m, (orientation * point).z());
      highest_m = std::max(highest_m, (orientation * point).z());
    }
    expect_crossing(detect(index, path, make(pyramid)), lowest_m, highest_m);
    expect_crossing(detect(index, path, make(fin)), lowest_m, highest_m);
  }
}

// A small obstacle that is completely inside a body touches none of its faces for most of the path.
TEST(Bodies, AreSolidThroughAndThrough) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-0.001, -0.001, -0.001}, {0.001, 0.001, 0.001});
  const SceneIndex index = SceneIndex::build(mesh);
  const Path path = descent(Quat::Identity());
  expect_crossing(detect(index, path, make(motion::BoxShape{Vec3::Zero(), {0.5, 0.5, 0.8}})),
                  -0.401, 0.401);
  expect_crossing(detect(index, path, make(motion::SphereShape{Vec3::Zero(), 0.4})), -0.401, 0.401);
  // The obstacle is inside from the beginning to the end.
  const Path rest = motion::interpolate(std::vector<Keyframe>{
      {0.0, {{0, 0, 0.1}, Quat::Identity()}}, {1.0, {{0, 0, -0.1}, Quat::Identity()}}});
  for (const motion::BodyShape& shape :
       {motion::BodyShape(motion::BoxShape{Vec3::Zero(), {0.5, 0.5, 0.8}}),
        motion::BodyShape(motion::SphereShape{Vec3::Zero(), 0.4})}) {
    const std::vector<CollisionInterval> found = detect(index, rest, make(shape));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].t_begin_s, 0.0);
    EXPECT_EQ(found[0].t_end_s, 1.0);
    // The deepest pose is near the middle of the path, a quarter of a metre from the sides.
    ASSERT_TRUE(found[0].witness);
    EXPECT_NEAR(found[0].witness->depth_m, 0.3, 0.11);
    EXPECT_LT(found[0].witness->point_W.norm(), 0.01);
    EXPECT_EQ(
        path_clearance(Obstacles(index), rest, make(shape), base::Deadline::never())->lower_bound_m,
        0.0);
  }
}

TEST(Bodies, RequiredClearanceIsKeptToTheTolerance) {
  const SceneIndex index = large_plate();
  for (const double clearance_m : {0.02, 0.3}) {
    const Path path = descent(Quat::Identity());
    expect_crossing(detect(index, path, Body(testing::small_camera()), clearance_m),
                    -0.1 - clearance_m, -0.1 + clearance_m);
    expect_crossing(detect(index, path, make(motion::SphereShape{Vec3::Zero(), 0.2}), clearance_m),
                    -0.2 - clearance_m, 0.2 + clearance_m);
  }
}

TEST(Bodies, ClearanceIsThatOfTheSurface) {
  const SceneIndex index = large_plate();
  const Path path = motion::interpolate(std::vector<Keyframe>{
      {0.0, {{-1, 0, 1}, Quat::Identity()}}, {1.0, {{1, 0, 1}, Quat::Identity()}}});
  for (const auto& [shape, truth_m] :
       {std::pair(motion::BodyShape(motion::SphereShape{Vec3::Zero(), 0.4}), 0.6),
        std::pair(motion::BodyShape(motion::BoxShape{Vec3::Zero(), {1, 1, 1}}), 0.5)}) {
    const PathClearance found =
        *path_clearance(Obstacles(index), path, make(shape), base::Deadline::never());
    EXPECT_LE(found.lower_bound_m, truth_m);
    EXPECT_GE(found.lower_bound_m, 0.8 * truth_m);
  }
}

TEST(Bodies, WitnessNamesTriangleFeatureAndDepth) {
  Mesh mesh;
  testing::add_triangle(mesh, {-50, -50, -9}, {50, -50, -9}, {0, 80, -9});
  testing::add_triangle(mesh, {0.05, -50, -1}, {0.05, 50, -1}, {0.05, 0, 1});
  const SceneIndex index = SceneIndex::build(mesh);
  const Body camera(testing::small_camera());
  const std::vector<CollisionInterval> found = detect(index, descent(Quat::Identity()), camera);
  ASSERT_EQ(found.size(), 1u);
  ASSERT_TRUE(found[0].witness);
  const Witness& witness = *found[0].witness;
  EXPECT_EQ(witness.triangle, 1u);
  EXPECT_GE(witness.time_s, found[0].t_begin_s);
  EXPECT_LE(witness.time_s, found[0].t_end_s);
  // The part of the quadrilateral to the right of the plane x = 0.05 is beyond it.
  const double right_m = motion::near_corners_C(testing::small_camera())[0].x();
  EXPECT_NEAR(witness.depth_m, right_m - 0.05, 1e-9);
  EXPECT_NEAR(witness.point_W.x(), 0.05, 1e-12);
  EXPECT_THAT(camera.feature_name(witness.feature), ::testing::StartsWith("edge"));
}

}  // namespace
}  // namespace camway::collision
