// SPDX-License-Identifier: MIT
#include "daemon/paper/keyframe_insertion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "daemon/motion/spline/interpolate.h"
#include "tests/support/scenes.h"

namespace camway::paper {
namespace {

using base::Deadline;
using collision::CollisionInterval;
using geometry::Quat;
using geometry::Vec3;
using motion::Corners;
using motion::Keyframe;
using motion::KeyframeOrigin;
using scene::Mesh;
using scene::SceneIndex;

Corners corners_C() { return motion::near_corners_C(testing::small_camera()); }

// Returns three keyframes whose path bulges towards x = 0.3 near z = 0.
std::vector<Keyframe> bulging_tour() {
  return {{0.0, {{0, 0, 2}, Quat::Identity()}},
          {2.0, {{0.25, 0, 0.4}, Quat::Identity()}},
          {4.0, {{0, 0, -2}, Quat::Identity()}}};
}

KeyframeInsertionResult correct(const SceneIndex& index, const std::vector<Keyframe>& keyframes,
                                const KeyframeInsertionOptions& options = {}) {
  return insert_keyframes(index, keyframes, corners_C(), options, base::Deadline::never());
}

std::vector<CollisionInterval> collisions(const SceneIndex& index, const motion::Path& path) {
  return *collision::detect_collisions({collision::Obstacles(index), motion::Body(corners_C())},
                                       path, path.begin_s(), path.end_s(), base::Deadline::never());
}

SceneIndex column_at(double x_min, double z) {
  Mesh mesh;
  testing::add_cuboid(mesh, {x_min, -3, z - 0.1}, {x_min + 0.2, 3, z + 0.1});
  return SceneIndex::build(mesh);
}

TEST(KeyframeInsertion, AGrazedColumnIsCorrected) {
  const SceneIndex index = column_at(0.31, -0.1);
  const std::vector<Keyframe> given = bulging_tour();
  ASSERT_FALSE(collisions(index, motion::interpolate(given)).empty());
  const KeyframeInsertionResult result = correct(index, given);
  EXPECT_TRUE(collisions(index, result.path).empty());
  EXPECT_EQ(result.gave_up, 0);
  EXPECT_GT(result.keyframes.size(), given.size());
  // All given keyframes are there, unchanged, and in order with the inserted ones.
  std::vector<Keyframe> kept;
  for (const Keyframe& keyframe : result.keyframes) {
    if (keyframe.origin == KeyframeOrigin::kGiven) kept.push_back(keyframe);
  }
  ASSERT_EQ(kept.size(), given.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    EXPECT_EQ(kept[i].time_s, given[i].time_s);
    EXPECT_EQ(kept[i].pose.position, given[i].pose.position);
  }
  EXPECT_TRUE(
      std::is_sorted(result.keyframes.begin(), result.keyframes.end(),
                     [](const Keyframe& a, const Keyframe& b) { return a.time_s < b.time_s; }));
}

TEST(KeyframeInsertion, AFreePathIsLeftAlone) {
  const SceneIndex index = column_at(3.0, 0.0);
  const KeyframeInsertionResult result = correct(index, bulging_tour());
  EXPECT_EQ(result.keyframes.size(), bulging_tour().size());
  EXPECT_EQ(result.rounds, 0);
}

TEST(KeyframeInsertion, TwoCollisionsAreBothCorrected) {
  Mesh mesh;
  testing::add_cuboid(mesh, {0.31, -3, -0.2}, {0.5, 3, 0.0});
  testing::add_cuboid(mesh, {0.24, -3, 1.05}, {0.5, 3, 1.2});
  const SceneIndex index = SceneIndex::build(mesh);
  ASSERT_EQ(collisions(index, motion::interpolate(bulging_tour())).size(), 2u);
  const KeyframeInsertionResult result = correct(index, bulging_tour());
  EXPECT_TRUE(collisions(index, result.path).empty());
}

TEST(KeyframeInsertion, AWallHeadOnIsGivenUpAndLeavesNoDents) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-50, -50, -0.05}, {50, 50, 0.05});
  const SceneIndex index = SceneIndex::build(mesh);
  const std::vector<Keyframe> given = bulging_tour();
  const KeyframeInsertionResult result = correct(index, given);
  EXPECT_GT(result.gave_up, 0);
  EXPECT_EQ(result.keyframes.size(), given.size());
  EXPECT_FALSE(collisions(index, result.path).empty());
}

TEST(KeyframeInsertion, AnEnclosedObjectIsFoundAndHonestlyGivenUp) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-0.005, -0.005, -0.005}, {0.005, 0.005, 0.005});
  const SceneIndex index = SceneIndex::build(mesh);
  const std::vector<Keyframe> given{{0.0, {{0.03, 0, 1}, Quat::Identity()}},
                                    {1.0, {{0.03, 0, -1}, Quat::Identity()}}};
  const KeyframeInsertionResult result = correct(index, given);
  EXPECT_EQ(result.gave_up, 1);
}

TEST(KeyframeInsertion, TheCutOffOnKeyframesHolds) {
  KeyframeInsertionOptions options;
  options.max_inserted_keyframes = 0;
  const KeyframeInsertionResult result = correct(column_at(0.31, -0.1), bulging_tour(), options);
  EXPECT_EQ(result.keyframes.size(), bulging_tour().size());
  EXPECT_EQ(result.gave_up, 1);
}

TEST(KeyframeInsertion, StopsAtTheDeadline) {
  const KeyframeInsertionResult result = insert_keyframes(
      column_at(0.31, -0.1), bulging_tour(), corners_C(), {}, base::Deadline::after_s(0.0));
  EXPECT_TRUE(result.timed_out);
  EXPECT_EQ(result.keyframes.size(), bulging_tour().size());
}

}  // namespace
}  // namespace camway::paper
