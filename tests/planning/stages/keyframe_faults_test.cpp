// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/keyframe_faults.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using geometry::Quat;
using geometry::Vec3;

constexpr double kRadius_m = 0.1;

std::vector<KeyframeFault> faults_of(const scene::Mesh& mesh, const std::vector<Vec3>& positions,
                                     const base::Deadline& deadline) {
  const auto snapshot = scene::make_snapshot("test", mesh).snapshot;
  const auto body = motion::Body::make(motion::SphereShape{Vec3::Zero(), kRadius_m});
  std::vector<motion::Keyframe> keyframes;
  for (const Vec3& position : positions) {
    keyframes.push_back({double(keyframes.size()), {position, Quat::Identity()}});
  }
  return find_keyframe_faults(*snapshot, {collision::Obstacles(*snapshot), *body}, keyframes,
                              deadline)
      .faults;
}

std::vector<KeyframeFault> faults_of(const scene::Mesh& mesh, const std::vector<Vec3>& positions) {
  return faults_of(mesh, positions, base::Deadline::never());
}

// Returns a floor whose top is at y = 0, thick enough to contain the sphere.
scene::Mesh floor() {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-50, -0.4, -50}, {50, 0, 50});
  return mesh;
}

// Returns a closed surface, a metre around the origin.
scene::Mesh room() {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-1, -1, -1}, {1, 1, 1});
  return mesh;
}

TEST(KeyframeFaults, NameWhatCollides) {
  const auto faults = faults_of(floor(), {{0, 1, 0}, {0, 0.04, 0}, {0, 0.11, 0}, {1, -0.02, 0}});
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].keyframe, 1U);
  EXPECT_NEAR(faults[0].depth_m, 0.06, 1e-6);
  EXPECT_EQ(faults[1].keyframe, 3U);
  EXPECT_TRUE(faults_of(floor(), {{0, 1, 0}, {0, 2, 0}}).empty());
}

// The nearest free pose would be inside the floor.
TEST(KeyframeFaults, AreFreeWhereTheirNeighboursAre) {
  for (const std::vector<Vec3>& positions : {std::vector<Vec3>{{0, 1, 0}, {1, -0.06, 0}, {2, 1, 0}},
                                             {{1, -0.06, 0}, {2, 1, 0}},
                                             {{0, 1, 0}, {1, -0.06, 0}},
                                             {{0, 1, 0}, {1, -0.06, 0}, {2, -0.06, 0}}}) {
    const auto faults = faults_of(floor(), positions);
    ASSERT_FALSE(faults.empty());
    for (const KeyframeFault& fault : faults) {
      ASSERT_TRUE(fault.free_pose);
      EXPECT_GT(fault.free_pose->position.y(), kRadius_m);
      EXPECT_LT(fault.free_pose->position.y(), 1.1 * kRadius_m + 0.01);
    }
  }
}

// The closed room contains everything, and also the repaired keyframe.
TEST(KeyframeFaults, StayInARoomThatIsItselfClosed) {
  const auto faults = faults_of(room(), {{0, 0, 0}, {1.05, 0.3, 0}, {0.5, 0, 0}, {0, -1.02, 0}});
  ASSERT_EQ(faults.size(), 2U);
  for (const KeyframeFault& fault : faults) {
    ASSERT_TRUE(fault.free_pose);
    EXPECT_LT(fault.free_pose->position.cwiseAbs().maxCoeff(), 1.0 - kRadius_m);
  }
}

TEST(KeyframeFaults, AreFreeOnTheNearerSideWhereTheirNeighboursAreApart) {
  for (const double x_m : {0.95, 1.05}) {
    const auto faults = faults_of(room(), {{0, 0, 0}, {x_m, 0, 0}, {2, 0, 0}});
    ASSERT_EQ(faults.size(), 1U);
    ASSERT_TRUE(faults[0].free_pose);
    EXPECT_EQ(faults[0].free_pose->position.x() < 1.0, x_m < 1.0);
  }
}

TEST(KeyframeFaults, GoWhereMostAreIfAllCollide) {
  for (const double sign : {1.0, -1.0}) {
    const auto faults = faults_of(
        room(), {{1 + 0.04 * sign, 0, 0}, {0, 1 + 0.03 * sign, 0}, {-1 + 0.05 * sign, 0, 0}});
    ASSERT_EQ(faults.size(), 3U);
    for (const KeyframeFault& fault : faults) {
      ASSERT_TRUE(fault.free_pose);
      EXPECT_EQ(fault.free_pose->position.cwiseAbs().maxCoeff() > 1.0, sign > 0.0);
    }
  }
}

// A keyframe below a floor that is no solid moves through it, if that is not much further.
TEST(KeyframeFaults, AreFreeInViewOfTheirNeighboursIfThatIsNotFar) {
  scene::Mesh mesh;
  testing::add_triangle(mesh, {-50, 0, -50}, {50, 0, -50}, {0, 0, 90});
  for (const double y_m : {-0.015, -0.08}) {
    const auto faults = faults_of(mesh, {{0, 1, 0}, {1, y_m, 0}, {2, 1, 0}});
    ASSERT_EQ(faults.size(), 1U);
    ASSERT_TRUE(faults[0].free_pose);
    EXPECT_EQ(faults[0].free_pose->position.y() > 0.0, y_m > -0.05);
  }
}

// The keyframe collides with a plate inside a solid, and the others are outside: the free space
// beside the plate is on the wrong side.
TEST(KeyframeFaults, HaveNoFreePoseOnTheWrongSide) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-9, -9, -9}, {9, 9, 9});
  testing::add_triangle(mesh, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  const auto faults = faults_of(mesh, {{0, 0, 20}, {0, 0, 0}, {0, 0, 20}});
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_FALSE(faults[0].free_pose);
}

TEST(KeyframeFaults, AreNamedWhenThereIsNoTimeToRepairThem) {
  const auto faults = faults_of(floor(), {{0, 1, 0}, {0, 0, 0}}, base::Deadline::after_s(0.0));
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_FALSE(faults[0].free_pose);
}

TEST(KeyframeFaults, AreNotCountedOnAndOn) {
  const std::vector<Vec3> positions(kMostKeyframeFaults + 20, Vec3(0, 0, 0));
  EXPECT_EQ(faults_of(floor(), positions, base::Deadline::after_s(0.0)).size(),
            kMostKeyframeFaults);
}

}  // namespace
}  // namespace camway::planning
