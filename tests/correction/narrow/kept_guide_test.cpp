// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/kept_guide.h"

#include <gtest/gtest.h>

#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file
using base::Deadline;

constexpr double kMargin_m = 0.002;
constexpr double kWall_m = 0.2;  // thickness
const OrientationPolicy kKept{.rule = OrientationRule::kKeep};

/// A wall about the plane z = 0 with a hole of that size about the z axis.
scene::Mesh wall_with_hole(double width_m, double height_m) {
  const double x_m = 0.5 * width_m;
  const double y_m = 0.5 * height_m;
  const double z_m = 0.5 * kWall_m;
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-3, -3, -z_m}, {-x_m, 3, z_m});
  testing::add_cuboid(mesh, {x_m, -3, -z_m}, {3, 3, z_m});
  testing::add_cuboid(mesh, {-x_m, -3, -z_m}, {x_m, -y_m, z_m});
  testing::add_cuboid(mesh, {-x_m, y_m, -z_m}, {x_m, 3, z_m});
  return mesh;
}

motion::Body box(const Vec3& size_m) {
  return *motion::Body::make(motion::BoxShape{Vec3::Zero(), size_m});
}

/// A scene, a way through it and the poses of the path as interpolated.
struct Crossing {
  SearchScene scene;
  std::vector<Vec3> way_W;
  std::vector<motion::Pose> interpolated;

  [[nodiscard]] std::optional<Guide> guide(const Deadline& deadline = Deadline::never()) const {
    FreeSpace space = scene.space(kKept);
    const SignedPose from = motion::signed_pose(interpolated.front());
    const SignedPose to = motion::signed_pose(interpolated.back());
    return kept_guide(space, way_W, from, to, interpolated, kMargin_m, deadline);
  }

  /// Expects a guide that is free, and joins the ends. Returns it.
  [[nodiscard]] Guide checked_guide() const {
    const std::optional<Guide> found = guide();
    EXPECT_TRUE(found);
    if (!found) return {};
    EXPECT_TRUE(is_proved_free(scene, *found, 0.0));
    EXPECT_EQ(found->front().position, interpolated.front().position);
    EXPECT_EQ(found->back().position, interpolated.back().position);
    EXPECT_TRUE(found->back().orientation == geometry::wxyz(interpolated.back().orientation));
    return *found;
  }
};

/// A box before a hole that is larger by a share of its size, turned in the world. The way is off
/// the middle of the hole by `off_m`.
Crossing box_and_hole(const Vec3& size_m, double spare, const Vec3& off_m, const Quat& turn_W) {
  scene::Mesh mesh = wall_with_hole((1.0 + spare) * size_m.x(), (1.0 + spare) * size_m.y());
  for (Vec3& vertex : mesh.vertices) vertex = turn_W * vertex;
  std::vector<Vec3> way_W = {{0.4, 0.2, 2.0}, {0, 0, 0.3}, {0, 0, -0.3}, {-0.3, 0.3, -2.0}};
  for (Vec3& point : way_W) point = turn_W * (point + off_m);
  return {SearchScene(mesh, box(size_m)), way_W, {{way_W.front(), turn_W}, {way_W.back(), turn_W}}};
}

TEST(KeptGuide, LeadsABoxThroughAHoleWithoutTurns) {
  testing::Random random(4811);
  std::uniform_real_distribution<double> side_m(0.3, 0.9);
  std::uniform_real_distribution<double> off_m(0.05, 0.1);
  for (int run = 0; run < 24; ++run) {
    SCOPED_TRACE(run);
    const Quat turn_W = random.rotation();
    const Vec3 size_m(side_m(random), side_m(random), side_m(random));
    const double spare = run % 3 == 0 ? 0.02 : 0.05 * (run % 3);
    const Vec3 off(off_m(random), off_m(random), 0.0);
    for (const SignedPose& pose : box_and_hole(size_m, spare, off, turn_W).checked_guide()) {
      EXPECT_NEAR(pose.orientation.dot(geometry::wxyz(turn_W)), 1.0, 1e-12);
    }
  }
}

/// A robot that stands just above the floor before a door.
Crossing robot_and_door(double door_m) {
  const Vec3 size_m(0.7, 1.6, 0.6);
  const double above_m = 0.02;
  scene::Mesh mesh = wall_with_hole(door_m, 2.0 * (0.5 * size_m.y() + 0.1));
  const double floor_m = -0.5 * size_m.y() - above_m;
  testing::add_cuboid(mesh, {-3, floor_m - 0.1, -3}, {3, floor_m, 3});
  return {SearchScene(mesh, box(size_m)),
          {{0.3, 0, 2}, {0.06, 0, 0.2}, {-0.06, 0, -0.2}, {-0.2, 0, -2}},
          {{{0.3, 0, 2}, Quat::Identity()}, {{-0.2, 0, -2}, Quat::Identity()}}};
}

// The ball about the body fits nowhere above the floor, and the body has little room.
TEST(KeptGuide, LeadsARobotThroughADoorJustAboveTheFloor) {
  for (const double door_m : {0.72, 0.75, 0.8}) {
    SCOPED_TRACE(door_m);
    const Guide guide = robot_and_door(door_m).checked_guide();
    for (const SignedPose& pose : guide) EXPECT_LT(std::abs(pose.position.y()), 0.1);
    EXPECT_LE(guide.size(), 6U) << "straight but at the door";
  }
}

// The ways of balls lead from cell to cell, where the robot would meet the floor.
TEST(KeptGuide, LeavesOutTheBendsOfTheWay) {
  Crossing crossing = robot_and_door(0.75);
  crossing.way_W.insert(crossing.way_W.begin() + 1, {{0.1, -0.3, 1.4}, {0.5, 0.4, 1.0}});
  const Guide guide = crossing.checked_guide();
  for (const SignedPose& pose : guide) EXPECT_LT(std::abs(pose.position.y()), 0.1);
}

TEST(KeptGuide, HasTheOrientationOfThePathWhereItIs) {
  const double turn_rad = 0.1;
  Crossing crossing = box_and_hole({0.5, 0.5, 0.5}, 0.2, {0.1, 0.1, 0}, Quat::Identity());
  crossing.interpolated.back().orientation = Quat(Eigen::AngleAxisd(turn_rad, Vec3::UnitZ()));
  const Guide guide = crossing.checked_guide();
  double before_rad = 0.0;
  for (const SignedPose& pose : guide) {
    const double angle_rad = 2.0 * std::atan2(pose.orientation[3], pose.orientation[0]);
    EXPECT_GE(angle_rad, before_rad - 1e-9);
    before_rad = angle_rad;
  }
  ASSERT_GT(guide.size(), 2U);
  for (const std::size_t i : {std::size_t{1}, guide.size() - 2}) {
    const double angle_rad = 2.0 * std::atan2(guide[i].orientation[3], guide[i].orientation[0]);
    EXPECT_NEAR(angle_rad, 0.5 * turn_rad, 0.4 * turn_rad);
  }
}

TEST(KeptGuide, IsShortThroughAWideHole) {
  Crossing crossing = box_and_hole({0.3, 0.3, 0.3}, 1.0, Vec3::Zero(), Quat::Identity());
  EXPECT_LE(crossing.checked_guide().size(), 4U);
  crossing.way_W = {crossing.way_W.front()};
  EXPECT_FALSE(crossing.guide()) << "no way";
}

TEST(KeptGuide, NoneWhereTheBodyOnlyFitsTurned) {
  Crossing crossing = box_and_hole({0.3, 0.8, 0.3}, 0.1, Vec3::Zero(), Quat::Identity());
  for (motion::Pose& pose : crossing.interpolated) {
    pose.orientation = Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()));
  }
  EXPECT_FALSE(crossing.guide());
}

// Both are so thin that the body is free at all places of the way.
TEST(KeptGuide, NoneThroughAThinWall) {
  Crossing crossing = box_and_hole({0.5, 0.5, 0.01}, 0.1, Vec3::Zero(), Quat::Identity());
  EXPECT_TRUE(crossing.guide());
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-3, -3, 0.03}, {3, 3, 0.035});
  const Crossing closed{SearchScene(mesh, box({0.5, 0.5, 0.01})), crossing.way_W,
                        crossing.interpolated};
  EXPECT_FALSE(closed.guide());
}

TEST(KeptGuide, NoneOnceTheDeadlineHasPassed) {
  const Crossing crossing = box_and_hole({0.3, 0.3, 0.3}, 0.1, {0.1, 0, 0}, Quat::Identity());
  EXPECT_TRUE(crossing.guide());
  EXPECT_FALSE(crossing.guide(Deadline::after_s(0.0)));
}

}  // namespace
}  // namespace camway::correction
