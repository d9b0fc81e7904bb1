// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/bench/decompositions/decomposition.h"
#include "tests/scene/index/index_bounds.h"
#include "tests/scene/index/index_queries.h"
#include "tests/scene/test_meshes.h"
#include "tests/support/case_name.h"

namespace camway::scene {
namespace {

using bench::build_box_hierarchy;
using bench::build_kd_tree;

// The oracles of the octree, for the other trees that may serve as the scene's index.

INSTANTIATE_TEST_SUITE_P(
    Others, IndexQueries,
    ::testing::Values(QueryCase{"KdTreeSoup", 511, false, 8, build_kd_tree},
                      QueryCase{"KdTreeGrid", 512, true, 2, build_kd_tree},
                      QueryCase{"BoxHierarchySoup", 513, false, 8, build_box_hierarchy},
                      QueryCase{"BoxHierarchyGrid", 514, true, 2, build_box_hierarchy},
                      QueryCase{"ManyMeshes", 522, false, 2, build_box_hierarchy, 97}),
    testing::name_of_case);

INSTANTIATE_TEST_SUITE_P(Others, IndexBounds,
                         ::testing::Values(TreeKind{"KdTree", build_kd_tree},
                                           TreeKind{"BoxHierarchy", build_box_hierarchy}),
                         testing::name_of_case);

}  // namespace
}  // namespace camway::scene

namespace camway::bench {
namespace {

using geometry::RandomTriangles;
using geometry::Triangle;
using geometry::Vec3;
using scene::IndexTree;
using scene::Mesh;

TEST(Decompositions, AreTheSameForAnyNumberOfThreads) {
  RandomTriangles random(508);
  // More than one chunk of work.
  const auto mesh =
      std::make_shared<const Mesh>(scene::mesh_of_triangles(scene::soup(random, 30'000)));
  for (const scene::BuildIndexedMesh build : {build_kd_tree, build_box_hierarchy}) {
    const IndexTree one = build(mesh, {.threads = 1})->tree;
    for (const unsigned threads : {0U, 2U, 7U}) {
      ASSERT_TRUE(one.is_same_as(build(mesh, {.threads = threads})->tree)) << threads;
    }
  }
}

TEST(Decompositions, AllAnswerAlike) {
  RandomTriangles random(515);
  for (const double size_m : {1e-3, 1.0, 1e5}) {
    std::vector<Triangle> triangles = scene::soup(random, 3000);
    for (Triangle& t : triangles) {
      for (Vec3& v : t) v *= size_m;
    }
    const auto mesh = std::make_shared<const Mesh>(scene::mesh_of_triangles(triangles));
    std::vector<std::unique_ptr<const Decomposition>> all;
    for (const DecompositionKind& kind : decomposition_kinds()) all.push_back(kind.build(mesh, 1));
    for (int i = 0; i < 500; ++i) {
      const Vec3 at = size_m * random.in_cube(6.0);
      const Vec3 e = size_m * random.in_cube(0.2);
      const Vec3 f = size_m * random.in_cube(0.2);
      // A parallelogram, like a near quadrilateral.
      const std::array<Triangle, 2> body = {Triangle{at, at + e, at + e + f},
                                            Triangle{at, at + e + f, at + f}};
      const auto nearest = all[0]->nearest(body, scene::kInfinity);
      for (const auto& other : all) {
        scene::expect_equal(other->nearest(body, scene::kInfinity), nearest);
        EXPECT_EQ(other->touches(body), nearest->distance_m == 0.0);
        EXPECT_FALSE(other->any_within(body, nearest->distance_m));
        EXPECT_TRUE(other->any_within(body, std::nextafter(nearest->distance_m, 1e9)));
        EXPECT_GT(other->cost_within(body, 0.1 * size_m).nodes, 0U);
      }
      if (::testing::Test::HasFailure()) return;
    }
  }
}

}  // namespace
}  // namespace camway::bench
