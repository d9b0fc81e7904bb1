// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_regions.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/correction/cell_scene.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file

constexpr double kRegionBall_m = 0.02;
// Sides of cells are 2 m, 1 m, 0.5 m and so on: this is the smallest of them.
constexpr double kRegionCell_m = 0.0625;
const CellOptions kRegionOptions{.ball_radius_m = kRegionBall_m, .smallest_m = kRegionCell_m};

constexpr OfEnds<bool> kNeitherIsNarrow = {false, false};

/// A wall across the cube at z = 0, 10 cm thick. The begin reached what is above it.
CellScene& with_upper_half(CellScene& c) {
  c.reach(0, [](const Vec3& center_W) { return center_W.z() > 0.0; });
  return c;
}

bool is_in_lower_corner(const Vec3& point_W) {
  return point_W.x() < -0.5 && point_W.y() < -0.5 && point_W.z() < 0.0;
}

TEST(CellRegions, HoldTheCellsOfEachEndAndTheWallsBesideThem) {
  CellScene c(wall_with_gap(2.0, 3.0), kRegionOptions);
  with_upper_half(c);
  c.reach(1, is_in_lower_corner);
  const OfEnds<CellRegion> regions = regions_reached(c.tree);
  // The cells nearest to the wall that are free begin at most two cells beyond the ball.
  const double wall_m = 0.05 + kRegionBall_m;
  const double most_m = wall_m + 2.0 * kRegionCell_m;
  EXPECT_LT(regions[0].volume_m3, 4.0 * (1.0 - wall_m));
  EXPECT_GT(regions[0].volume_m3, 4.0 * (1.0 - most_m));
  EXPECT_LT(regions[1].volume_m3, 0.25 * (1.0 - wall_m));
  EXPECT_GT(regions[1].volume_m3, 0.25 * (1.0 - most_m));
  for (const CellRegion& region : regions) EXPECT_EQ(region.unsure_m, 0.5 * kRegionCell_m);
  EXPECT_EQ(regions[0].box_W.max(), Vec3::Constant(1.0));
  EXPECT_LT(regions[0].box_W.min().z(), wall_m + kRegionCell_m) << "has no middle of a mixed cell";
  EXPECT_EQ(regions[1].box_W.min(), Vec3::Constant(-1.0));
  EXPECT_TRUE(regions[1].box_W.max().head<2>().isConstant(-0.5));
}

TEST(CellRegions, AreEmptyWhereNothingWasReached) {
  const CellScene c(wall_with_gap(2.0, 3.0), kRegionOptions);
  for (const CellRegion& region : regions_reached(c.tree)) {
    EXPECT_EQ(region.volume_m3, 0.0);
    EXPECT_TRUE(region.box_W.isEmpty());
  }
  EXPECT_FALSE(pocket_so_far(c.tree, kNeitherIsNarrow, /*has_way=*/false));
}

TEST(CellRegions, APlaceIsNarrowWithoutACellThatHasRoom) {
  CellScene c(wall_with_gap(2.0, 3.0), kRegionOptions);
  // Between the wall and 0.3 m in front of it, and the whole other side.
  c.reach(0, [](const Vec3& center_W) { return center_W.z() > 0.0 && center_W.z() < 0.3; });
  c.reach(1, [](const Vec3& center_W) { return center_W.z() < 0.0; });
  EXPECT_EQ(ends_in_narrow_places(c.tree, 0.4), (OfEnds<bool>{true, false}));
  EXPECT_EQ(ends_in_narrow_places(c.tree, 0.1), kNeitherIsNarrow);
  EXPECT_EQ(ends_in_narrow_places(c.tree, 2.0), (OfEnds<bool>{true, true}));
  EXPECT_EQ(ends_in_narrow_places(c.tree, 0.0), kNeitherIsNarrow) << "0 takes no place for narrow";
}

TEST(CellRegions, ACompletePocketIsThatOfTheEndThatWasSearched) {
  for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
    CellScene c(wall_with_gap(2.0, 3.0), kRegionOptions);
    c.reach(1 - end, [](const Vec3& center_W) { return center_W.z() > 0.0; });
    c.reach(end, is_in_lower_corner);
    const Pocket pocket = complete_pocket(c.tree, end, {true, false});
    EXPECT_EQ(pocket.is_at_end, end == 1);
    EXPECT_TRUE(pocket.is_complete);
    EXPECT_EQ(pocket.is_narrow, end == 0);
    EXPECT_EQ(pocket.reached_W.min(), Vec3::Constant(-1.0));
    EXPECT_EQ(pocket.unsure_m, 0.5 * kRegionCell_m);
  }
}

TEST(CellRegions, APocketSoFarIsTheOneWithMuchLessSpace) {
  CellScene c(wall_with_gap(2.0, 3.0), kRegionOptions);
  with_upper_half(c);
  c.reach(1, is_in_lower_corner);  // a sixteenth of the other
  const std::optional<Pocket> pocket = pocket_so_far(c.tree, kNeitherIsNarrow, /*has_way=*/false);
  ASSERT_TRUE(pocket);
  EXPECT_TRUE(pocket->is_at_end);
  EXPECT_FALSE(pocket->is_complete);
  EXPECT_FALSE(pocket->is_narrow);
  EXPECT_FALSE(pocket_so_far(c.tree, kNeitherIsNarrow, /*has_way=*/true))
      << "the way leads out of it";
}

TEST(CellRegions, NeitherOfTwoAlikeIsAPocketUnlessItIsNarrow) {
  CellScene c(wall_with_gap(2.0, 3.0), kRegionOptions);
  with_upper_half(c);
  c.reach(1, [](const Vec3& center_W) { return center_W.z() < 0.0; });
  EXPECT_FALSE(pocket_so_far(c.tree, kNeitherIsNarrow, /*has_way=*/false));
  for (const bool is_at_end : {false, true}) {
    const OfEnds<bool> is_narrow = {!is_at_end, is_at_end};
    for (const bool has_way : {false, true}) {
      const std::optional<Pocket> pocket = pocket_so_far(c.tree, is_narrow, has_way);
      ASSERT_TRUE(pocket);
      EXPECT_EQ(pocket->is_at_end, is_at_end);
      EXPECT_TRUE(pocket->is_narrow);
    }
  }
}

}  // namespace
}  // namespace camway::correction
