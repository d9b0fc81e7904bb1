// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/shut_in_list.h"

#include <gtest/gtest.h>

#include <vector>

namespace camway::correction {
namespace {

using geometry::Vec3;

constexpr double kHalfPocket_m = 0.5;
constexpr double kUnsure_m = 0.1;

/// A cube of 1 m about `center_W`, found about the beginning of an interval.
Pocket complete_pocket(const Vec3& center_W) {
  const geometry::Box box(center_W.array() - kHalfPocket_m, center_W.array() + kHalfPocket_m);
  return {.reached_W = box, .unsure_m = kUnsure_m};
}

Pocket unfinished_pocket(bool is_at_end, bool is_narrow, double x_m = 0.0) {
  Pocket pocket = complete_pocket({x_m, 0, 0});
  pocket.is_at_end = is_at_end;
  pocket.is_complete = false;
  pocket.is_narrow = is_narrow;
  return pocket;
}

std::vector<ShutIn> all_open(const ShutInList& list) {
  return list.all([](std::size_t) { return true; });
}

TEST(ShutInList, ShutsOffTheIntervalsOnBothSidesOfACompletePocket) {
  const Vec3 inside_W = Vec3::Zero();
  const Vec3 outside_W(2, 0, 0);
  ShutInList list;
  EXPECT_FALSE(list.is_shut_off(4, inside_W, outside_W));
  list.add(4, complete_pocket(inside_W));
  EXPECT_TRUE(list.is_shut_off(4, inside_W, outside_W));
  EXPECT_TRUE(list.is_shut_off(3, outside_W, inside_W));
  // An interval that does not end at keyframe 4 is not concerned.
  EXPECT_FALSE(list.is_shut_off(5, inside_W, outside_W));
  // A way within the pocket may exist.
  EXPECT_FALSE(list.is_shut_off(4, inside_W, {0.4, 0, 0}));
  // Half a cell beyond the box may still be reachable.
  EXPECT_FALSE(list.is_shut_off(4, inside_W, {kHalfPocket_m + 0.9 * kUnsure_m, 0, 0}));
  EXPECT_TRUE(list.is_shut_off(4, inside_W, {kHalfPocket_m + 1.1 * kUnsure_m, 0, 0}));
}

TEST(ShutInList, ShutsNothingOffByAnUnfinishedPocket) {
  ShutInList list;
  list.add(4, unfinished_pocket(/*is_at_end=*/false, /*is_narrow=*/true));
  EXPECT_FALSE(list.is_shut_off(4, Vec3::Zero(), {9, 0, 0}));
}

// Keyframe 2 ends interval 1 and begins interval 2.
TEST(ShutInList, SparesOnlySearchesFromANarrowPlaceThatWasSearchedBefore) {
  ShutInList list;
  list.add(1, unfinished_pocket(/*is_at_end=*/true, /*is_narrow=*/true));
  list.add(2, unfinished_pocket(/*is_at_end=*/false, /*is_narrow=*/true));
  EXPECT_FALSE(list.is_worthless(1));
  EXPECT_FALSE(list.is_worthless(2));
  list.mark_searched(1);
  EXPECT_TRUE(list.is_worthless(2));
  EXPECT_FALSE(list.is_worthless(3));
}

TEST(ShutInList, SparesNoSearchFromAWidePlaceOrFromAnotherKeyframe) {
  ShutInList list;
  list.add(1, unfinished_pocket(/*is_at_end=*/true, /*is_narrow=*/true));
  list.add(2, unfinished_pocket(/*is_at_end=*/false, /*is_narrow=*/false));
  list.add(3, unfinished_pocket(/*is_at_end=*/false, /*is_narrow=*/true));
  list.mark_searched(1);
  EXPECT_FALSE(list.is_worthless(2)) << "the place is wide";
  EXPECT_FALSE(list.is_worthless(3)) << "the place is about another keyframe";
}

TEST(ShutInList, KeepsTheLastUnfinishedPocketOfAnInterval) {
  ShutInList list;
  list.add(1, unfinished_pocket(/*is_at_end=*/true, /*is_narrow=*/true));
  list.add(1, unfinished_pocket(/*is_at_end=*/false, /*is_narrow=*/false, 3.0));
  const std::vector<ShutIn> all = all_open(list);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].keyframe, 1U);
  EXPECT_FALSE(all[0].is_complete);
  EXPECT_TRUE(all[0].region_W.contains(Vec3(3, 0, 0)));
}

TEST(ShutInList, ListsCompletePocketsFirstAndEachKeyframeOnce) {
  ShutInList list;
  list.add(7, unfinished_pocket(/*is_at_end=*/false, /*is_narrow=*/false));
  list.add(2, unfinished_pocket(/*is_at_end=*/true, /*is_narrow=*/false));
  list.add(5, complete_pocket(Vec3::Zero()));
  list.add(3, complete_pocket(Vec3::Zero()));
  list.add(5, complete_pocket({4, 0, 0}));
  std::vector<std::size_t> keyframes;
  for (const ShutIn& shut_in : all_open(list)) keyframes.push_back(shut_in.keyframe);
  EXPECT_EQ(keyframes, (std::vector<std::size_t>{5, 3, 7}));
  EXPECT_TRUE(all_open(list)[0].region_W.contains(Vec3::Zero())) << "the first one is kept";
  EXPECT_TRUE(all_open(list)[1].is_complete);
}

TEST(ShutInList, LeavesOutUnfinishedPocketsOfIntervalsThatWereCorrected) {
  ShutInList list;
  list.add(1, unfinished_pocket(/*is_at_end=*/false, /*is_narrow=*/true));
  list.add(4, unfinished_pocket(/*is_at_end=*/false, /*is_narrow=*/true));
  list.add(6, complete_pocket(Vec3::Zero()));
  const std::vector<ShutIn> all = list.all([](std::size_t leg) { return leg == 4; });
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].keyframe, 6U);
  EXPECT_EQ(all[1].keyframe, 4U);
}

}  // namespace
}  // namespace camway::correction
