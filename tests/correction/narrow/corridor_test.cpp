// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/corridor.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/correction/search_scene.h"

namespace camway::correction {
namespace {

using base::Deadline;
using geometry::Quat;
using geometry::Vec3;
using motion::SignedPose;
using testing_search::is_proved_free;
using testing_search::SearchScene;

constexpr double kPoleTop_m = 2.0;
constexpr int kRingParts = 12;

/// A ring about the z axis whose hole holds a ball of 0.4 m.
motion::Body ring() {
  motion::ConvexShape shape;
  const double inner_m = 0.4 / std::cos(std::numbers::pi / kRingParts);
  for (int i = 0; i < kRingParts; ++i) {
    std::vector<Vec3>& piece = shape.pieces_C.emplace_back();
    for (const int k : {i, i + 1}) {
      const double angle_rad = 2.0 * std::numbers::pi * k / kRingParts;
      for (const double radius_m : {inner_m, inner_m + 0.15}) {
        for (const double z_m : {-0.08, 0.08}) {
          piece.emplace_back(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m);
        }
      }
    }
  }
  return *motion::Body::make(shape);
}

/// A pole that fills the hole of the ring but for a share.
SearchScene pole(double spare) {
  const double half_m = 0.4 / (1.0 + spare) / std::numbers::sqrt2;
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-half_m, -half_m, 0}, {half_m, half_m, kPoleTop_m});
  testing::add_cuboid(mesh, {-3, -3, -0.1}, {3, 3, 0});
  return SearchScene(mesh, ring());
}

// The bounds do not say where to go. Without an end, a deadline would be the only one.
TEST(WayOut, IsNoneWhereOnlyTheBoundsAreNear) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-10, -10, 8}, {10, 10, 8.1});
  const SearchScene scene(mesh,
                          *motion::Body::make(motion::BoxShape{Vec3::Zero(), Vec3(0.4, 0.4, 0.2)}));
  collision::Obstacles obstacles(scene.index);
  obstacles.bounds.max_W.y() = 0.23;
  FreeSpace space({obstacles, scene.body, {}});
  const SignedPose from = motion::signed_pose({Vec3::Zero(), Quat::Identity()});
  ASSERT_TRUE(space.is_free(motion::unsigned_pose(from), 0.0));
  EXPECT_FALSE(way_out(space, from, RoomTest::kGap, Deadline::never()));
}

TEST(WayOut, LiftsARingOffItsPole) {
  for (const double spare : {0.02, 0.1, 3.0}) {
    const RoomTest room_test = spare > 1.0 ? RoomTest::kBall : RoomTest::kGap;
    for (const double tilt_rad : {0.0, 0.01}) {
      const SearchScene scene = pole(spare);
      FreeSpace space = scene.space();
      const SignedPose from =
          motion::signed_pose({Vec3(0, 0, 1.0), Quat(Eigen::AngleAxisd(tilt_rad, Vec3::UnitX()))});
      const std::optional<Guide> way = way_out(space, from, room_test, Deadline::never());
      ASSERT_TRUE(way) << spare;
      EXPECT_EQ(way->front().position, from.position);
      EXPECT_GT(way->back().position.z(), kPoleTop_m);
      EXPECT_TRUE(is_proved_free(scene, *way, 0.0));
    }
  }
}

TEST(WayOut, IsNoneWhereTheBodyHasRoomAlready) {
  const SearchScene scene = pole(0.1);
  FreeSpace space = scene.space();
  const SignedPose from = motion::signed_pose({Vec3(1.8, 0, 1.2), Quat::Identity()});
  const std::optional<Guide> way = way_out(space, from, RoomTest::kGap, Deadline::never());
  ASSERT_TRUE(way);
  EXPECT_EQ(way->size(), 1U);
}

TEST(WayOut, IsNotFoundFromAnotherRingThatIsClosed) {
  // A lid on the pole that is larger than the ring, and the floor below.
  SearchScene open = pole(0.1);
  scene::Mesh mesh = open.mesh;
  testing::add_cuboid(mesh, {-2, -2, kPoleTop_m}, {2, 2, kPoleTop_m + 0.1});
  const SearchScene scene(mesh, ring());
  FreeSpace space = scene.space();
  const SignedPose from = motion::signed_pose({Vec3(0, 0, 1.0), Quat::Identity()});
  EXPECT_FALSE(way_out(space, from, RoomTest::kGap, Deadline::never()));
}

TEST(Corridor, LeadsThroughAPipeToBothSides) {
  // A square pipe along z for a box.
  constexpr double kHalf_m = 0.155;
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-kHalf_m - 0.1, -kHalf_m, -1}, {-kHalf_m, kHalf_m, 1});
  testing::add_cuboid(mesh, {kHalf_m, -kHalf_m, -1}, {kHalf_m + 0.1, kHalf_m, 1});
  testing::add_cuboid(mesh, {-kHalf_m, -kHalf_m - 0.1, -1}, {kHalf_m, -kHalf_m, 1});
  testing::add_cuboid(mesh, {-kHalf_m, kHalf_m, -1}, {kHalf_m, kHalf_m + 0.1, 1});
  const SearchScene scene(mesh,
                          *motion::Body::make(motion::BoxShape{Vec3::Zero(), Vec3(0.3, 0.3, 0.6)}));
  FreeSpace space = scene.space();
  const SignedPose middle = motion::signed_pose({Vec3(0, 0, 0.1), Quat::Identity()});
  constexpr double kMargin_m = 0.001;
  const std::optional<Guide> way =
      corridor(space, middle, Vec3(0.1, 0, 1).normalized(), kMargin_m, Deadline::never());
  ASSERT_TRUE(way);
  EXPECT_LT(way->front().position.z(), -1.2);
  EXPECT_GT(way->back().position.z(), 1.2);
  EXPECT_TRUE(is_proved_free(scene, *way, kMargin_m));
}

// A body just above a floor has room nowhere near it: centred after each step, it would rise.
TEST(Corridor, GoesStraightOnBeyondWhereItsGoalsAreSeen) {
  scene::Mesh mesh = testing_search::wall_with_gap(-0.36, 0.36);
  testing::add_cuboid(mesh, {-3, -0.92, -3}, {3, -0.82, 3});
  testing::add_cuboid(mesh, {-0.4, 0.82, -0.05}, {0.4, 3, 0.05});
  const SearchScene scene(mesh,
                          *motion::Body::make(motion::BoxShape{Vec3::Zero(), Vec3(0.7, 1.6, 0.6)}));
  FreeSpace space = scene.space({.rule = OrientationRule::kKeep});
  const SignedPose middle = motion::signed_pose({Vec3::Zero(), Quat::Identity()});
  const CorridorGoals goals{motion::signed_pose({Vec3(0.5, 0, 1.8), Quat::Identity()}),
                            motion::signed_pose({Vec3(-0.3, 0, -1.8), Quat::Identity()})};
  const Vec3 ahead_W = Vec3(-0.2, 0, -1).normalized();
  const std::optional<Guide> way =
      corridor(space, middle, ahead_W, 0.001, Deadline::never(), &goals);
  ASSERT_TRUE(way);
  EXPECT_TRUE(is_proved_free(scene, *way, 0.001));
  EXPECT_EQ(way->front().position, goals.back.position);
  EXPECT_EQ(way->back().position, goals.forth.position);
  ASSERT_GT(way->size(), 3U);
  EXPECT_GT((*way)[1].position.z(), 0.7 * space.ball_radius_m());
  EXPECT_LT((*way)[way->size() - 2].position.z(), -0.7 * space.ball_radius_m());
  for (std::size_t i = 1; i + 1 < way->size(); ++i) {
    EXPECT_LT((*way)[i].position.head<2>().norm(), 0.01) << i;
  }
}

}  // namespace
}  // namespace camway::correction
