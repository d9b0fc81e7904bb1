// SPDX-License-Identifier: MIT
#include "daemon/correction/search/closed_corner.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::correction {
namespace {

using geometry::Bounds;
using geometry::Box;
using geometry::Quat;
using geometry::Vec3;

constexpr double kKeep_m = 0.01;

/// In the frame of the wall, turned as a whole: nothing of it is parallel to the axes but the box.
struct Seen {
  explicit Seen(scene::Mesh mesh_W) : mesh(std::move(mesh_W)) {}

  [[nodiscard]] bool closed(const Vec3& from, double half_m = 0.5) const {
    testing::Random random(7);
    bool first = false;
    for (int run = 0; run < 8; ++run) {
      const Quat turn_W = run == 0 ? Quat::Identity() : random.rotation();
      scene::Mesh turned = mesh;
      for (Vec3& vertex : turned.vertices) vertex = turn_W * vertex;
      const Vec3 half = Vec3::Constant(half_m);
      const scene::SceneIndex index = scene::SceneIndex::build(turned);
      const bool closed =
          closed_corner(collision::Obstacles(index), Box(-half, half), turn_W * from, kKeep_m)
              .has_value();
      if (run == 0) first = closed;
      EXPECT_EQ(closed, first) << run;
    }
    return first;
  }

  scene::Mesh mesh;
};

/// In the plane z = `z_m`, from x, y = -3 to 3, of four plates about a square hole at the middle.
void add_wall(scene::Mesh& mesh, double z_m, double hole_m) {
  const auto plate = [&](double x0, double y0, double x1, double y1) {
    testing::add_triangle(mesh, {x0, y0, z_m}, {x1, y0, z_m}, {x1, y1, z_m});
    testing::add_triangle(mesh, {x0, y0, z_m}, {x1, y1, z_m}, {x0, y1, z_m});
  };
  if (hole_m == 0.0) return plate(-3, -3, 3, 3);
  const double h = 0.5 * hole_m;
  plate(-3, -3, -h, 3);
  plate(h, -3, 3, 3);
  plate(-h, -3, h, -h);
  plate(-h, h, h, 3);
}

scene::Mesh wall(double hole_m) {
  scene::Mesh mesh;
  add_wall(mesh, 0.0, hole_m);
  return mesh;
}

TEST(ClosedCorner, ABareWallIsOneAndAHoleInItIsSeen) {
  EXPECT_TRUE(Seen(wall(0.0)).closed({0, 0, 0.3}));
  EXPECT_TRUE(Seen(wall(0.0)).closed({0.1, 0, -0.3}));
  for (const double hole_m : {0.03, 0.1, 0.3}) EXPECT_FALSE(Seen(wall(hole_m)).closed({0, 0, 0.3}));
}

TEST(ClosedCorner, WhatIsThereTwiceClosesNoHole) {
  scene::Mesh mesh = wall(0.2);
  add_wall(mesh, 0.0, 0.2);
  EXPECT_FALSE(Seen(mesh).closed({0, 0, 0.3}));
  add_wall(mesh, 0.5 * kKeep_m, 0.2);
  EXPECT_FALSE(Seen(mesh).closed({0, 0, 0.3}));
}

TEST(ClosedCorner, WhatIsBehindAWallDoesNotCount) {
  scene::Mesh mesh = wall(0.0);
  add_wall(mesh, -0.05, 0.2);
  EXPECT_TRUE(Seen(mesh).closed({0, 0, 0.3}));
  EXPECT_FALSE(Seen(mesh).closed({0, 0, -0.3})) << "the hole is in front, from there";
}

TEST(ClosedCorner, NothingIsSaidOfWhatIsBetweenTwoWalls) {
  scene::Mesh mesh = wall(0.0);
  add_wall(mesh, 0.4, 0.0);
  EXPECT_FALSE(Seen(mesh).closed({0, 0, 0.2}));
}

TEST(ClosedCorner, AWallStandsOnAFloorIfTheSlitIsTooNarrow) {
  for (const double slit_m : {0.0, 0.5 * kKeep_m, 3.0 * kKeep_m}) {
    scene::Mesh corner = wall(0.0);
    testing::add_cuboid(corner, {-0.1, -2.9, slit_m}, {0.0, 2.8, 4.0});
    EXPECT_EQ(Seen(corner).closed({0.3, 0, 0.3}), slit_m < kKeep_m) << slit_m;
  }
}

// As if a wall without holes stood there.
TEST(ClosedCorner, ASideOfTheBoundsIsAWall) {
  const auto closed = [](const scene::Mesh& mesh, const Bounds& bounds, const Vec3& from) {
    const scene::SceneIndex index = scene::SceneIndex::build(mesh);
    const Vec3 half = Vec3::Constant(0.5);
    return closed_corner(collision::Obstacles(index).within(bounds), Box(-half, half), from,
                         kKeep_m)
        .has_value();
  };
  Bounds bounds;
  bounds.min_W.z() = 0.0;
  EXPECT_TRUE(closed({}, bounds, {0, 0, 0.3}));
  EXPECT_FALSE(closed({}, bounds, {0, 0, 0.5 * kKeep_m}));
  EXPECT_FALSE(closed({}, bounds, {0, 0, -0.3})) << "beyond the bounds";
  scene::Mesh hole_beyond;
  add_wall(hole_beyond, -0.1, 0.2);
  EXPECT_TRUE(closed(hole_beyond, bounds, {0, 0, 0.3}));
  scene::Mesh opposite;
  add_wall(opposite, 0.4, 0.0);
  EXPECT_FALSE(closed(opposite, bounds, {0, 0, 0.2})) << "what is between them leads on";
  scene::Mesh beside;
  testing::add_cuboid(beside, {-0.1, -3, -3}, {0.0, 3, 3});
  EXPECT_TRUE(closed(beside, bounds, {0.3, 0, 0.3})) << "a corner with a wall";
}

TEST(ClosedCorner, EmptySpaceIsNone) {
  EXPECT_FALSE(Seen(scene::Mesh{}).closed({0, 0, 0.3}));
  EXPECT_FALSE(Seen(wall(0.0)).closed({0, 0, 0.5 * kKeep_m})) << "too near to tell the side";
}

}  // namespace
}  // namespace camway::correction
