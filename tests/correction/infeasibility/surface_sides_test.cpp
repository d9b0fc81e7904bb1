// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/surface_sides.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::correction {
namespace {

using geometry::Vec3;

struct Sides {
  explicit Sides(scene::Mesh mesh_W)
      : mesh(std::make_shared<const scene::Mesh>(std::move(mesh_W))),
        index(scene::SceneIndex::build(*mesh)),
        sides(mesh, index) {}

  scene::WholeMesh mesh;
  scene::SceneIndex index;
  SurfaceSides sides;
};

// Cuboids that may contain or intersect each other. Coordinates are small integers, so rays often
// pass through vertices and along edges and faces.
TEST(SurfaceSides, AreTheSameExactlyInTheSameCuboids) {
  testing::Random random(1);
  std::uniform_int_distribution<int> corner(0, 8);
  for (int run = 0; run < 50; ++run) {
    std::vector<geometry::Box> boxes;
    scene::Mesh mesh;
    while (boxes.size() < 5) {
      geometry::Box box;
      for (int k = 0; k < 2; ++k) {
        const int x = corner(random);
        const int y = corner(random);
        const int z = corner(random);
        box.extend(Vec3(x, y, z));
      }
      if (box.sizes().minCoeff() <= 0.0) continue;
      boxes.push_back(box);
      testing::add_cuboid(mesh, box.min(), box.max());
    }
    const Sides sides(std::move(mesh));
    using Holders = std::array<bool, 5>;
    std::vector<std::pair<scene::IndexSet, Holders>> seen;
    for (int i = 0; i < 40; ++i) {
      const Vec3 point = Vec3(corner(random), corner(random), corner(random)) + Vec3::Constant(0.5);
      Holders holders{};
      for (std::size_t k = 0; k < boxes.size(); ++k) holders[k] = boxes[k].contains(point);
      const std::optional<scene::IndexSet> around = sides.sides.around(point);
      ASSERT_TRUE(around);
      for (const auto& [other_around, other_holders] : seen) {
        ASSERT_EQ(*around == other_around, holders == other_holders) << point.transpose();
      }
      seen.emplace_back(*around, holders);
    }
  }
}

TEST(SurfaceSides, WhatIsOpenHasNoInside) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(Sides(mesh).sides.around({0.5, 0.5, 0.5})->size(), 1U);
  EXPECT_TRUE(Sides(mesh).sides.around({-0.5, 0.5, 0.5})->empty());
  mesh.triangles.pop_back();
  EXPECT_TRUE(Sides(mesh).sides.around({0.5, 0.5, 0.5})->empty());
  EXPECT_TRUE(Sides(scene::Mesh()).sides.around({0.5, 0.5, 0.5})->empty());
}

TEST(SurfaceSides, OnTheSurfaceIsOnNoSide) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {0, 0, 0}, {1, 1, 1});
  EXPECT_FALSE(Sides(mesh).sides.around({1, 0.25, 0.5}));
}

}  // namespace
}  // namespace camway::correction
