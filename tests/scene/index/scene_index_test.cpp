// SPDX-License-Identifier: MIT
#include "daemon/scene/index/scene_index.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/scene/index/index_queries.h"
#include "tests/scene/test_meshes.h"
#include "tests/support/case_name.h"

namespace camway::scene {
namespace {

using geometry::moved;
using geometry::RandomTriangles;
using geometry::Triangle;
using geometry::Vec3;

INSTANTIATE_TEST_SUITE_P(
    Octrees, IndexQueries,
    ::testing::Values(QueryCase{"Soup", 501, false, 8}, QueryCase{"SoupDeep", 502, false, 1},
                      QueryCase{"Grid", 503, true, 8}, QueryCase{"GridDeep", 504, true, 2},
                      QueryCase{"TwoMeshes", 521, false, 8, IndexedMesh::build, 2},
                      QueryCase{"ManyMeshes", 522, false, 2, IndexedMesh::build, 97},
                      QueryCase{"MeshEach", 523, true, 4, IndexedMesh::build, 500}),
    testing::name_of_case);

TEST(SceneIndex, ThresholdAndDepthAreObeyed) {
  RandomTriangles random(507);
  const Mesh mesh = mesh_of_triangles(soup(random, 2000));
  const SceneIndex shallow = SceneIndex::build(mesh, {.threshold = 1, .max_depth = 2});
  EXPECT_EQ(shallow.statistics().depth, 2U);
  const SceneIndex all_in_one = SceneIndex::build(mesh, {.threshold = 2000});
  EXPECT_EQ(all_in_one.statistics().leaves, 1U);
  EXPECT_EQ(all_in_one.statistics().duplication, 1.0);
  EXPECT_GT(SceneIndex::build(mesh, {.threshold = 4}).statistics().leaves,
            SceneIndex::build(mesh, {.threshold = 64}).statistics().leaves);
}

TEST(SceneIndex, IsTheSameForAnyNumberOfThreads) {
  RandomTriangles random(508);
  // More than one chunk of work.
  const auto mesh = std::make_shared<const Mesh>(mesh_of_triangles(soup(random, 30'000)));
  const SceneIndex one = SceneIndex::build(mesh, {.threads = 1});
  for (const unsigned threads : {0U, 1U, 2U, 7U}) {
    const SceneIndex other = SceneIndex::build(mesh, {.threads = threads});
    EXPECT_EQ(one.statistics(), other.statistics());
    ASSERT_TRUE(one.has_same_trees_as(other)) << threads;
  }
  EXPECT_FALSE(SceneIndex::build(mesh, {.threshold = 4})
                   .has_same_trees_as(SceneIndex::build(mesh, {.threshold = 5})));
}

TEST(SceneIndex, NearestIsTheNearestAtAnyScale) {
  RandomTriangles random(515);
  for (const double size_m : {1e-3, 1.0, 1e5}) {
    std::vector<Triangle> triangles = soup(random, 3000);
    for (Triangle& t : triangles) {
      for (Vec3& v : t) v *= size_m;
    }
    const auto mesh = std::make_shared<const Mesh>(mesh_of_triangles(triangles));
    const SceneIndex octree = SceneIndex::build(mesh);
    for (int i = 0; i < 50; ++i) {
      const Vec3 at = size_m * random.in_cube(6.0);
      const Vec3 e = size_m * random.in_cube(0.2);
      const Vec3 f = size_m * random.in_cube(0.2);
      // A parallelogram, like a near quadrilateral.
      const std::array<Triangle, 2> body = {Triangle{at, at + e, at + e + f},
                                            Triangle{at, at + e + f, at + f}};
      expect_equal(octree.nearest(body, kInfinity), brute_nearest(octree, body, kInfinity));
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(SceneIndex, NeverCallsSpaceFreeForAPoseThatIsNoPose) {
  RandomTriangles random(516);
  const SceneIndex tree = SceneIndex::build(mesh_of_triangles(soup(random, 100)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, kInfinity, -kInfinity, 0x1p201, -0x1p300}) {
    for (int k = 0; k < 9; ++k) {
      Triangle t = {Vec3(1e3, 0, 0), Vec3(1e3, 1, 0), Vec3(1e3, 0, 1)};
      ASSERT_FALSE(tree.nearest(std::array<Triangle, 1>{t}, 1.0));
      t[static_cast<std::size_t>(k / 3)][k % 3] = bad;
      for (const double cutoff_m : {1.0, 0.0, kInfinity}) {
        expect_equal(tree.nearest(std::array<Triangle, 1>{t}, cutoff_m), Nearest{0.0, 0});
        expect_equal(tree.any_within(std::array<Triangle, 1>{t}, cutoff_m), Nearest{0.0, 0});
        expect_equal(tree.near(std::array<Triangle, 1>{t}, cutoff_m, 0.0, 0.5), Nearest{0.0, 0});
      }
      EXPECT_TRUE(tree.intersects(t));
      EXPECT_EQ(tree.first_intersection(t), std::optional<std::uint32_t>(0));
      if (k < 3) expect_equal(tree.closest_hit({t[0], t[1]}), SegmentHit{0.0, 0});
      EXPECT_FALSE(SceneIndex().nearest(std::array<Triangle, 1>{t}, 1.0));
    }
  }
  const Triangle good = {Vec3(1e3, 0, 0), Vec3(1e3, 1, 0), Vec3(1e3, 0, 1)};
  expect_equal(tree.nearest(std::array<Triangle, 1>{good}, nan), Nearest{0.0, 0});
  std::set<std::uint32_t> visited;
  const geometry::Box box(Vec3(nan, nan, nan), Vec3(nan, nan, nan));
  EXPECT_TRUE(tree.for_each_touching(box, [&](std::uint32_t t) {
    visited.insert(t);
    return true;
  }));
  EXPECT_EQ(visited.size(), tree.size());
}

TEST(SceneIndex, SharesItsMeshAndCountsACopy) {
  RandomTriangles random(517);
  const auto mesh = std::make_shared<const Mesh>(mesh_of_triangles(soup(random, 1000)));
  const SceneIndex shared = SceneIndex::build(mesh);
  const SceneIndex copied = SceneIndex::build(*mesh);
  EXPECT_EQ(mesh.use_count(), 2);
  EXPECT_EQ(copied.statistics().memory_bytes - shared.statistics().memory_bytes,
            1000 * (3 * sizeof(Vec3) + 3 * sizeof(std::uint32_t)));
}

TEST(SceneIndex, AnEmptySceneAnswersNothing) {
  for (const SceneIndex& tree : {SceneIndex(), SceneIndex::build(Mesh())}) {
    const Triangle t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    EXPECT_FALSE(tree.first_intersection(t));
    EXPECT_FALSE(tree.intersects(t));
    EXPECT_FALSE(tree.closest_hit({t[0], t[1]}));
    EXPECT_FALSE(tree.nearest(std::array<Triangle, 1>{t}, kInfinity));
    std::vector<std::uint32_t> leaves = {7};
    tree.leaves_touching(t, leaves);
    EXPECT_TRUE(leaves.empty());
  }
}

TEST(SceneIndex, AnswersFarFromTheOrigin) {
  RandomTriangles random(509);
  const Vec3 far(1e6, -2e6, 5e5);
  std::vector<Triangle> triangles = soup(random, 500);
  for (Triangle& t : triangles) t = moved(t, far);
  const SceneIndex tree = SceneIndex::build(mesh_of_triangles(triangles), {.threshold = 4});
  for (int i = 0; i < 300; ++i) {
    const Triangle t = moved({random.in_cube(5.0), random.in_cube(5.0), random.in_cube(5.0)}, far);
    ASSERT_EQ(tree.first_intersection(t), brute_first_intersection(tree, t));
    expect_equal(tree.nearest(std::array<Triangle, 1>{t}, kInfinity),
                 brute_nearest(tree, std::array<Triangle, 1>{t}, kInfinity));
  }
}

}  // namespace
}  // namespace camway::scene
