// SPDX-License-Identifier: MIT
#include "tests/scene/index/index_bounds.h"

#include <array>
#include <cmath>
#include <numbers>

#include "tests/scene/test_meshes.h"

namespace camway::scene {

using geometry::moved;
using geometry::RandomTriangles;
using geometry::Triangle;
using geometry::Vec3;

SceneIndex IndexBounds::build(Mesh mesh, const IndexOptions& options) {
  return SceneIndex::of(
      std::array{GetParam().build(std::make_shared<const Mesh>(std::move(mesh)), options)});
}

void IndexBounds::expect_bounded(const SceneIndex& tree) {
  const IndexStatistics& s = tree.statistics();
  std::printf("%llu triangles: %llu nodes, %llu leaves, depth %u, duplication %.2f, %.1f MB\n",
              static_cast<unsigned long long>(s.triangles),
              static_cast<unsigned long long>(s.nodes), static_cast<unsigned long long>(s.leaves),
              s.depth, s.duplication, static_cast<double>(s.memory_bytes) * 1e-6);
  const auto triangles = static_cast<double>(s.triangles);
  EXPECT_LE(s.depth, IndexOptions{}.max_depth);
  EXPECT_LE(static_cast<double>(s.references), IndexOptions{}.max_duplication * triangles);
  EXPECT_GE(s.references, s.triangles);
  EXPECT_LE(static_cast<double>(s.memory_bytes), 100.0 * triangles + 1e4);
}

void IndexBounds::expect_nearest(const SceneIndex& tree, const Vec3& at, const Vec3& edge) {
  const std::array<Triangle, 1> body = {Triangle{at, at + edge, at}};
  const auto expected = brute_nearest(tree, body, kInfinity);
  expect_equal(tree.nearest(body, kInfinity), expected);
  if (expected->distance_m == 0.0) return;
  EXPECT_TRUE(tree.any_within(body, 2.0 * expected->distance_m));
  EXPECT_FALSE(tree.any_within(body, 0.5 * expected->distance_m));
}

TEST_P(IndexBounds, AFanOfAMillionTrianglesAtOneVertex) {
  constexpr std::uint32_t kCount = 1'000'000;
  Mesh fan;
  fan.vertices.emplace_back(0, 0, 1);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCount;
    fan.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.3 * std::sin(7.0 * angle));
    fan.triangles.push_back({0, i + 1, (i + 1) % kCount + 1});
  }
  const SceneIndex tree = build(std::move(fan));
  expect_bounded(tree);
  RandomTriangles random(518);
  for (int i = 0; i < 3; ++i) expect_nearest(tree, random.in_cube(1.5), random.in_cube(0.1));
}

TEST_P(IndexBounds, AMillionCopiesOfOneTriangle) {
  Mesh copies;
  copies.vertices = {Vec3(0, 0, 0), Vec3(3, 1, 0), Vec3(1, 4, 2)};
  copies.triangles.assign(1'000'000, {0, 1, 2});
  const SceneIndex tree = build(std::move(copies));
  expect_bounded(tree);
  // A split cannot separate them, so it is not tried.
  EXPECT_EQ(tree.statistics().leaves, 1U);
  const std::array<Triangle, 1> body = {tree.triangle(0)};
  expect_equal(tree.nearest(body, kInfinity), Nearest{0.0, 0});
  expect_nearest(tree, Vec3(2, 2, 2), Vec3(0.1, 0, 0));
}

TEST_P(IndexBounds, OneHugeTriangleOverAMillionGrainsOfDust) {
  RandomTriangles random(505);
  std::vector<Triangle> scene = {{Vec3(-100, -90, -1), Vec3(120, -80, 1), Vec3(0, 150, 0)}};
  for (int i = 0; i < 1'000'000; ++i) {
    const Vec3 at = random.in_cube(1.0);
    scene.push_back(
        {at + random.in_cube(1e-4), at + random.in_cube(1e-4), at + random.in_cube(1e-4)});
  }
  const SceneIndex tree = build(mesh_of_triangles(scene));
  expect_bounded(tree);
  EXPECT_LT(tree.statistics().duplication, 1.5);
  for (int i = 0; i < 3; ++i) expect_nearest(tree, random.in_cube(1.5), random.in_cube(0.1));
}

TEST_P(IndexBounds, ManyPointsAtOnePlace) {
  const Vec3 p(1e6, -1e6, 3.0);
  const SceneIndex tree = build(mesh_of_triangles(std::vector<Triangle>(5000, {p, p, p})));
  expect_bounded(tree);
  EXPECT_EQ(tree.first_intersection({p, p, p}), std::optional<std::uint32_t>(0));
  expect_nearest(tree, p + Vec3(1, 0, 0), Vec3(0.1, 0.1, 0));
}

TEST_P(IndexBounds, ManyPointsOnALine) {
  std::vector<Triangle> points;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 p(0.5, 1e-3 * i, -2.0);
    points.push_back({p, p, p});
  }
  const SceneIndex tree = build(mesh_of_triangles(points));
  expect_bounded(tree);
  EXPECT_GT(tree.statistics().leaves, 500U);
  expect_nearest(tree, Vec3(0, 7.123, 0), Vec3(0.1, 0.1, 0));
}

TEST_P(IndexBounds, SizesThatSpanManyPowersOfTen) {
  std::vector<Triangle> scene;
  for (int i = -60; i < 60; ++i) {
    const double size = std::pow(10.0, i);
    scene.push_back({Vec3(size, 0, 0), Vec3(0, size, 0), Vec3(0, 0, size)});
    scene.push_back({Vec3(-size, size, 0), Vec3(-size, size, 0), Vec3(-size, 0, size)});
  }
  const SceneIndex tree = build(mesh_of_triangles(scene), {.threshold = 1});
  RandomTriangles random(519);
  for (int i = -70; i < 55; ++i) {
    const double size = std::pow(10.0, i);
    expect_nearest(tree, size * random.in_cube(3.0), size * random.in_cube(0.1));
  }
}

TEST_P(IndexBounds, AHouseBesideAStrayTriangleFarAway) {
  RandomTriangles random(520);
  std::vector<Triangle> scene = soup(random, 20'000);
  scene.push_back({Vec3(1e9, 0, 0), Vec3(1e9, 1, 0), Vec3(1e9, 0, 1)});
  const SceneIndex tree = build(mesh_of_triangles(scene));
  expect_bounded(tree);
  // The house is divided all the same.
  EXPECT_GT(tree.statistics().leaves, 50U);
  for (int i = 0; i < 20; ++i) expect_nearest(tree, random.in_cube(6.0), random.in_cube(0.1));
}

TEST_P(IndexBounds, AFlatSceneIsNotDuplicatedByItsPlane) {
  RandomTriangles random(506);
  std::vector<Triangle> floor;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 at(random.uniform(0, 40), random.uniform(0, 30), 0.0);
    floor.push_back({at, at + Vec3(0.1, 0, 0), at + Vec3(0, 0.1, 0)});
  }
  const SceneIndex tree = build(mesh_of_triangles(floor));
  expect_bounded(tree);
  EXPECT_LT(tree.statistics().duplication, 1.5);
}

TEST_P(IndexBounds, SliversAndPointsAreFoundLikeOthers) {
  RandomTriangles random(521);
  std::vector<Triangle> scene;
  for (int i = 0; i < 1500; ++i) scene.push_back(moved(random.thin_triangle(), random.in_cube(8)));
  const SceneIndex tree = build(mesh_of_triangles(scene), {.threshold = 3});
  for (int i = 0; i < 100; ++i) {
    expect_nearest(tree, random.in_cube(10.0), random.in_cube(0.5));
    const Triangle t = moved(random.thin_triangle(), random.in_cube(8));
    ASSERT_EQ(tree.first_intersection(t), brute_first_intersection(tree, t));
  }
}

}  // namespace camway::scene
