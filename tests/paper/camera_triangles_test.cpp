// SPDX-License-Identifier: MIT
#include "daemon/paper/camera_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "daemon/geometry/triangle_intersection.h"
#include "tests/geometry/random_triangles.h"
#include "tests/scene/test_meshes.h"

namespace camway::paper {
namespace {

using geometry::RandomTriangles;
using geometry::Triangle;
using geometry::Vec3;
using scene::IndexStatistics;
using scene::SceneIndex;

class CameraTrianglesTest : public ::testing::Test {
 protected:
  CameraTrianglesTest() : random_(601) {
    std::vector<Triangle> scene;
    for (int i = 0; i < 600; ++i) scene.push_back(triangle(1.0));
    tree_ = SceneIndex::build(scene::mesh_of_triangles(scene), {.threshold = 6});
  }

  Triangle triangle(double size) {
    const Vec3 at = random_.in_cube(5.0);
    return {at + random_.in_cube(size), at + random_.in_cube(size), at + random_.in_cube(size)};
  }

  RandomTriangles random_;
  SceneIndex tree_;
};

TEST_F(CameraTrianglesTest, HitsWhatTheWholeTreeHits) {
  CameraTriangles camera(tree_);
  int hits = 0;
  for (std::uint32_t id = 0; id < 500; ++id) {
    const Triangle t = triangle(0.5);
    camera.insert(id, t);
    const auto expected = tree_.first_intersection(t);
    hits += expected ? 1 : 0;
    ASSERT_EQ(camera.first_hit(id), expected);
  }
  EXPECT_GT(hits, 50);
  EXPECT_LT(hits, 450);
}

TEST_F(CameraTrianglesTest, NeverSplitsALeaf) {
  const IndexStatistics before = tree_.statistics();
  CameraTriangles camera(tree_);
  // Many more triangles than the threshold in the same place.
  const Triangle t = tree_.triangle(0);
  for (std::uint32_t id = 0; id < 1000; ++id) camera.insert(id, t);
  EXPECT_EQ(tree_.statistics(), before);
  const auto leaves = camera.leaves_of(0);
  ASSERT_FALSE(leaves.empty());
  EXPECT_EQ(camera.leaf_ids(leaves.front()).size(), 1000U);
}

TEST_F(CameraTrianglesTest, ListsAndLeavesAgree) {
  CameraTriangles camera(tree_);
  for (std::uint32_t id = 0; id < 200; ++id) camera.insert(id, triangle(1.0));
  for (std::uint32_t leaf = 0; leaf < tree_.statistics().leaves; ++leaf) {
    const std::vector<std::uint32_t> ids = camera.leaf_ids(leaf);
    ASSERT_TRUE(std::is_sorted(ids.begin(), ids.end()));
    for (std::uint32_t id = 0; id < 200; ++id) {
      const auto leaves = camera.leaves_of(id);
      ASSERT_EQ(std::binary_search(ids.begin(), ids.end(), id),
                std::find(leaves.begin(), leaves.end(), leaf) != leaves.end());
    }
  }
}

TEST_F(CameraTrianglesTest, InsertingAgainReplaces) {
  CameraTriangles camera(tree_);
  camera.insert(7, tree_.triangle(3));
  EXPECT_TRUE(camera.first_hit(7));
  const std::vector<std::uint32_t> old_leaves(camera.leaves_of(7).begin(),
                                              camera.leaves_of(7).end());
  const Vec3 far(1000, 1000, 1000);
  camera.insert(7, {far, far, far});
  EXPECT_EQ(camera.size(), 1U);
  EXPECT_FALSE(camera.first_hit(7));
  for (const std::uint32_t leaf : old_leaves) EXPECT_TRUE(camera.leaf_ids(leaf).empty());
}

TEST_F(CameraTrianglesTest, WalksInOrderOfIdAndStopsWhenAsked) {
  CameraTriangles camera(tree_);
  for (const std::uint32_t id : {9U, 2U, 30U, 4U}) camera.insert(id, triangle(1.0));
  std::vector<std::uint32_t> seen;
  camera.for_each_id([&](std::uint32_t id) {
    seen.push_back(id);
    return id != 9U;
  });
  EXPECT_EQ(seen, (std::vector<std::uint32_t>{2, 4, 9}));
}

TEST_F(CameraTrianglesTest, KnowsNothingOfAnUnknownId) {
  const CameraTriangles camera(tree_);
  EXPECT_FALSE(camera.first_hit(1));
  EXPECT_TRUE(camera.leaves_of(1).empty());
}

}  // namespace
}  // namespace camway::paper
