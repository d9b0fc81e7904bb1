// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/kept_passage.h"

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

  [[nodiscard]] std::optional<std::vector<NarrowPassage>> passages(
      const Deadline& deadline = Deadline::never()) const {
    FreeSpace space = scene.space(kKept);
    const SignedPose from = motion::signed_pose({way_W.front(), interpolated.front().orientation});
    return kept_passages(space, way_W, from, interpolated, kMargin_m, deadline);
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

TEST(KeptPassages, LeadABoxThroughAHoleWithoutTurns) {
  testing::Random random(4811);
  std::uniform_real_distribution<double> side_m(0.3, 0.9);
  std::uniform_real_distribution<double> off_m(0.05, 0.1);
  for (int run = 0; run < 24; ++run) {
    SCOPED_TRACE(run);
    const Quat turn_W = random.rotation();
    const Vec3 size_m(side_m(random), side_m(random), side_m(random));
    const double spare = run % 3 == 0 ? 0.02 : 0.05 * (run % 3);
    const Vec3 off(off_m(random), off_m(random), 0.0);
    const Crossing crossing = box_and_hole(size_m, spare, off, turn_W);
    const std::optional<std::vector<NarrowPassage>> found = crossing.passages();
    ASSERT_TRUE(found && found->size() == 1);
    const NarrowPassage& passage = found->front();
    const Guide& poses = passage.poses;
    EXPECT_TRUE(is_proved_free(crossing.scene, poses, 0.0));
    for (const SignedPose& pose : poses) {
      EXPECT_NEAR(pose.orientation.dot(geometry::wxyz(turn_W)), 1.0, 1e-12);
    }
    const auto before_m = [&](const SignedPose& pose) {
      return (turn_W.conjugate() * pose.position).z() - 0.5 * kWall_m - 0.5 * size_m.z();
    };
    EXPECT_GT(before_m(poses.front()), 0.0);
    EXPECT_GT(before_m({-poses.back().position, poses.back().orientation}), 0.0);
    EXPECT_LT(passage.first, passage.last);
  }
}

// The ball about the body fits nowhere above the floor, and the body has little room.
TEST(KeptPassages, LeadARobotThroughADoorJustAboveTheFloor) {
  const Vec3 size_m(0.7, 1.6, 0.6);
  const double above_m = 0.02;
  for (const double door_m : {0.72, 0.75, 0.8}) {
    SCOPED_TRACE(door_m);
    scene::Mesh mesh = wall_with_hole(door_m, 2.0 * (0.5 * size_m.y() + 0.1));
    const double floor_m = -0.5 * size_m.y() - above_m;
    testing::add_cuboid(mesh, {-3, floor_m - 0.1, -3}, {3, floor_m, 3});
    const Quat turn = Quat::Identity();
    const Crossing crossing{SearchScene(mesh, box(size_m)),
                            {{0.3, 0, 2}, {0.06, 0, 0.2}, {-0.06, 0, -0.2}, {-0.2, 0, -2}},
                            {{{0.3, 0, 2}, turn}, {{-0.2, 0, -2}, turn}}};
    const std::optional<std::vector<NarrowPassage>> found = crossing.passages();
    ASSERT_TRUE(found && found->size() == 1);
    const NarrowPassage& passage = found->front();
    EXPECT_TRUE(is_proved_free(crossing.scene, passage.poses, 0.0));
    for (const SignedPose& pose : passage.poses) EXPECT_LT(std::abs(pose.position.y()), 0.1);
    EXPECT_GT(passage.poses.front().position.z(), 0.5 * (kWall_m + size_m.z()));
    EXPECT_LT(passage.poses.back().position.z(), -0.5 * (kWall_m + size_m.z()));
  }
}

TEST(KeptPassages, HaveTheOrientationOfThePathWhereTheyAre) {
  const double turn_rad = 0.1;
  Crossing crossing = box_and_hole({0.5, 0.5, 0.5}, 0.2, {0.1, 0.1, 0}, Quat::Identity());
  crossing.interpolated.back().orientation = Quat(Eigen::AngleAxisd(turn_rad, Vec3::UnitZ()));
  const std::optional<std::vector<NarrowPassage>> found = crossing.passages();
  ASSERT_TRUE(found && found->size() == 1);
  const NarrowPassage& passage = found->front();
  const Guide& poses = passage.poses;
  EXPECT_TRUE(is_proved_free(crossing.scene, poses, 0.0));
  double before_rad = 0.0;
  for (const SignedPose& pose : poses) {
    const double angle_rad = 2.0 * std::atan2(pose.orientation[3], pose.orientation[0]);
    EXPECT_GE(angle_rad, before_rad);
    before_rad = angle_rad;
  }
  EXPECT_GT(before_rad, 0.3 * turn_rad);
  EXPECT_LT(before_rad, turn_rad);
}

TEST(KeptPassages, NoneWhereTheBodyOnlyFitsTurned) {
  Crossing crossing = box_and_hole({0.3, 0.8, 0.3}, 0.1, Vec3::Zero(), Quat::Identity());
  for (motion::Pose& pose : crossing.interpolated) {
    pose.orientation = Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()));
  }
  EXPECT_FALSE(crossing.passages());
}

TEST(KeptPassages, AreNoneWhereTheBodyFitsAnyway) {
  const Crossing crossing = box_and_hole({0.3, 0.3, 0.3}, 1.0, Vec3::Zero(), Quat::Identity());
  const std::optional<std::vector<NarrowPassage>> found = crossing.passages();
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->empty());
}

TEST(KeptPassages, NoneOnceTheDeadlineHasPassed) {
  const Crossing crossing = box_and_hole({0.3, 0.3, 0.3}, 0.1, {0.1, 0, 0}, Quat::Identity());
  EXPECT_TRUE(crossing.passages());
  EXPECT_FALSE(crossing.passages(Deadline::after_s(0.0)));
}

TEST(KeptWay, FollowsAWayThatIsFreeForTheBody) {
  Crossing crossing = box_and_hole({0.3, 0.3, 0.3}, 1.0, Vec3::Zero(), Quat::Identity());
  crossing.interpolated.back().orientation = Quat(Eigen::AngleAxisd(0.2, Vec3::UnitY()));
  const SignedPose from = motion::signed_pose(crossing.interpolated.front());
  const SignedPose to = motion::signed_pose(crossing.interpolated.back());
  const auto guide_along = [&](const std::vector<Vec3>& way_W) {
    FreeSpace space = crossing.scene.space(kKept);
    return kept_way(space, way_W, from, to, crossing.interpolated, kMargin_m);
  };
  const std::optional<Guide> guide = guide_along(crossing.way_W);
  ASSERT_TRUE(guide);
  EXPECT_TRUE(is_proved_free(crossing.scene, *guide, kMargin_m));
  EXPECT_EQ(guide->front().position, from.position);
  EXPECT_EQ(guide->back().orientation, to.orientation);
  const SignedPose& middle = (*guide)[guide->size() / 2];
  EXPECT_NEAR(2.0 * std::atan2(middle.orientation[2], middle.orientation[0]), 0.1, 0.02);
  EXPECT_FALSE(guide_along({crossing.way_W.front(), crossing.way_W.back()})) << "through the wall";
}

}  // namespace
}  // namespace camway::correction
