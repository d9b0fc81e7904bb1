// SPDX-License-Identifier: MIT
#include "daemon/correction/search/kept_cell_way.h"

#include <gtest/gtest.h>

#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using base::Deadline;
using geometry::Quat;
using geometry::Vec3;
using motion::SignedPose;
using testing_search::is_proved_free;
using testing_search::same;
using testing_search::scattered_cuboids;
using testing_search::SearchScene;

constexpr std::size_t kCells = 60'000;
const OrientationPolicy kKept{.rule = OrientationRule::kKeep};

/// A corridor along z, 3 m wide, with a table across it that leaves `gap_m` free beside it.
scene::Mesh corridor_with_table(double gap_m) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-1.6, 0, -4}, {-1.5, 2.5, 4});
  testing::add_cuboid(mesh, {1.5, 0, -4}, {1.6, 2.5, 4});
  testing::add_cuboid(mesh, {-1.6, -0.1, -4}, {1.6, 0, 4});
  testing::add_cuboid(mesh, {-1.6, 2.5, -4}, {1.6, 2.6, 4});
  for (const double side : {-1.0, 1.0}) {
    const double z_m = 4.0 * side;
    testing::add_cuboid(mesh, {-1.6, 0, std::min(z_m, z_m + 0.1 * side)},
                        {1.6, 2.5, std::max(z_m, z_m + 0.1 * side)});
  }
  testing::add_cuboid(mesh, {-1.5, 0.7, -0.4}, {1.5 - gap_m, 0.75, 0.4});
  return mesh;
}

/// A robot, 1.9 m high: higher than there is room above the table.
motion::Body robot() {
  return *motion::Body::make(motion::BoxShape{Vec3::Zero(), Vec3(0.6, 1.9, 0.5)});
}

TEST(KeptCellWay, LeadsRoundATableThatASmallBallPassesUnder) {
  const SearchScene scene(corridor_with_table(0.8), robot());
  FreeSpace space = scene.space(kKept);
  const SignedPose from = motion::signed_pose({Vec3(-0.8, 1.2, 2), Quat::Identity()});
  const Quat turned(Eigen::AngleAxisd(0.01, Vec3::UnitY()));
  const SignedPose to = motion::signed_pose({Vec3(-0.8, 1.1, -2), turned});
  const KeptWay way = kept_cell_way(space, from, to, kCells, Deadline::never());
  ASSERT_FALSE(way.guide.empty());
  EXPECT_TRUE(is_proved_free(scene, way.guide, 0.0));
  EXPECT_EQ(way.guide.front().position, from.position);
  EXPECT_EQ(way.guide.back().position, to.position);
  EXPECT_EQ(way.guide.back().orientation, to.orientation);
  double farthest_m = -1.0;
  for (const SignedPose& pose : way.guide) {
    EXPECT_NEAR(pose.orientation.dot(from.orientation), 1.0, 1e-4);
    farthest_m = std::max(farthest_m, pose.position.x());
  }
  EXPECT_GT(farthest_m, 1.0);
  EXPECT_LT(way.cells, kCells);
}

TEST(KeptCellWay, LeadsRoundAPlateWithNothingElseInTheScene) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-2, -2, -0.05}, {2, 2, 0.05});
  const SearchScene scene(mesh,
                          *motion::Body::make(motion::BoxShape{Vec3::Zero(), Vec3::Constant(0.6)}));
  FreeSpace space = scene.space(kKept);
  const SignedPose from = motion::signed_pose({Vec3(0, 0, 1), Quat::Identity()});
  const SignedPose to = motion::signed_pose({Vec3(0, 0, -1), Quat::Identity()});
  const KeptWay way = kept_cell_way(space, from, to, kCells, Deadline::never());
  ASSERT_FALSE(way.guide.empty());
  EXPECT_TRUE(is_proved_free(scene, way.guide, 0.0));
}

TEST(KeptCellWay, IsNoneWhereTheBodyDoesNotFit) {
  const SearchScene scene(corridor_with_table(0.55), robot());
  FreeSpace space = scene.space(kKept);
  const SignedPose from = motion::signed_pose({Vec3(-0.8, 1.2, 2), Quat::Identity()});
  const SignedPose to = motion::signed_pose({Vec3(-0.8, 1.1, -2), Quat::Identity()});
  EXPECT_TRUE(kept_cell_way(space, from, to, kCells, Deadline::never()).guide.empty());
  EXPECT_TRUE(kept_cell_way(space, from, to, kCells, Deadline::after_s(0.0)).guide.empty());
}

TEST(KeptCellWay, IsFreeAmongScatteredCuboids) {
  testing::Random random(4821);
  int found = 0;
  for (int run = 0; run < 12; ++run) {
    SCOPED_TRACE(run);
    const SearchScene scene(
        scattered_cuboids(random, 30, 0.6),
        *motion::Body::make(motion::BoxShape{Vec3::Zero(), Vec3(0.3, 0.2, 0.1)}));
    FreeSpace space = scene.space(kKept);
    const Quat turn = random.rotation();
    const SignedPose from = motion::signed_pose({Vec3(-2, 0, 0), turn});
    const SignedPose to = motion::signed_pose({Vec3(2, 0, 0), turn});
    const KeptWay way = kept_cell_way(space, from, to, kCells, Deadline::never());
    if (way.guide.empty()) continue;
    ++found;
    EXPECT_TRUE(is_proved_free(scene, way.guide, 0.0));
    EXPECT_TRUE(same(way.guide, kept_cell_way(space, from, to, kCells, Deadline::never()).guide));
  }
  EXPECT_GE(found, 10);
}

}  // namespace
}  // namespace camway::correction
