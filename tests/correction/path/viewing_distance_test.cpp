// SPDX-License-Identifier: MIT
#include "daemon/correction/path/viewing_distance.h"

#include <gtest/gtest.h>

#include <vector>

#include "daemon/motion/spline/interpolate.h"
#include "tests/correction/search_scene.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file
using motion::CubicPath;

/// Returns a path along x that looks along -Z.
CubicPath sideways() {
  const std::vector<motion::Keyframe> keyframes = {{0.0, {Vec3::Zero(), Quat::Identity()}},
                                                   {1.0, {Vec3(2, 0, 0), Quat::Identity()}}};
  return motion::interpolate_cubic(keyframes);
}

/// Returns a wall across the view at this distance.
scene::Mesh wall_at(double distance_m) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-30, -30, -distance_m - 1}, {30, 30, -distance_m});
  return mesh;
}

TEST(ViewingDistance, IsThatOfTheWallInViewWithinItsRange) {
  const double far_m = 2.0 * kMostViewingDistance_m;
  const double near_m = 0.5 * kLeastViewingDistance_m;
  EXPECT_NEAR(viewing_distance_m(sideways(), SearchScene(wall_at(4.5)).space()), 4.5, 1e-9);
  EXPECT_EQ(viewing_distance_m(sideways(), SearchScene(wall_at(far_m)).space()),
            kMostViewingDistance_m);
  EXPECT_EQ(viewing_distance_m(sideways(), SearchScene(wall_at(near_m)).space()),
            kLeastViewingDistance_m);
}

TEST(ViewingDistance, OfTheRequestIsTakenAsItIs) {
  const SearchScene scene(wall_at(4.5));
  EXPECT_EQ(closeness_of(sideways(), scene.space(), 0.125).viewing_distance_m, 0.125);
  EXPECT_NEAR(closeness_of(sideways(), scene.space(), 0.0).viewing_distance_m, 4.5, 1e-9);
}

// The near quadrilateral is off the eye, and yet the picture is seen from the eye.
TEST(ViewingDistance, CamerasMoveByTheirEyeAndTurnByTheDistance) {
  const SearchScene scene(wall_at(4.5));
  const Closeness closeness = closeness_of(sideways(), scene.space(), 3.0);
  ASSERT_GT(scene.space().center_C().norm(), 0.0);
  EXPECT_EQ(closeness.center_C, Vec3::Zero());
  EXPECT_EQ(closeness.turn_lever_m, 3.0);
}

TEST(ViewingDistance, OtherBodiesMoveByTheirCenterAndTurnByTheirRadius) {
  const Vec3 center_C(0.5, 0, -2);
  const SearchScene box(wall_at(4.5),
                        *motion::Body::make(motion::BoxShape{center_C, Vec3(0.2, 0.4, 0.4)}));
  const SearchScene ball(wall_at(4.5), *motion::Body::make(motion::SphereShape{center_C, 0.3}));
  for (const SearchScene* scene : {&box, &ball}) {
    const Closeness closeness = closeness_of(sideways(), scene->space(), 3.0);
    EXPECT_LT((closeness.center_C - center_C).norm(), 1e-15);
    EXPECT_NEAR(closeness.turn_lever_m, 0.3, 1e-15);
  }
}

}  // namespace
}  // namespace camway::correction
