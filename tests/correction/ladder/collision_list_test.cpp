// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/collision_list.h"

#include <gtest/gtest.h>

#include <vector>

#include "daemon/motion/spline/interpolate.h"

namespace camway::correction {
namespace {

using collision::CollisionInterval;

// Keyframes at 0, 2, 4 and 6 seconds.
const std::vector<double> kKeyframes_s = {0.0, 2.0, 4.0, 6.0};

motion::CubicPath path_along_x() {
  std::vector<motion::Keyframe> keyframes;
  for (const double time_s : kKeyframes_s) {
    keyframes.push_back({time_s, {{time_s, 0, 0}, geometry::Quat::Identity()}});
  }
  return motion::interpolate_cubic(keyframes);
}

void correct(ListedCollision& listed, double begin_s, double end_s) {
  listed.correction.kind = CorrectionKind::kMove;
  listed.correction.t_begin_s = begin_s;
  listed.correction.t_end_s = end_s;
}

TEST(CollisionList, DividesCollisionsAtKeyframes) {
  const CollisionList list({{0.5, 1.0}, {1.5, 4.5}, {5.0, 6.0}}, kKeyframes_s);
  const std::vector<CollisionInterval> parts = {
      {0.5, 1.0}, {1.5, 2.0}, {2.0, 4.0}, {4.0, 4.5}, {5.0, 6.0}};
  const std::vector<std::size_t> legs = {0, 0, 1, 2, 2};
  ASSERT_EQ(list.size(), parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_EQ(list[i].correction.interval, parts[i]) << i;
    EXPECT_EQ(list[i].leg, legs[i]) << i;
    EXPECT_TRUE(list[i].is_open());
  }
  EXPECT_EQ(list.count_legs(), 3u);
  EXPECT_EQ(list.count_open(), 5u);
}

TEST(CollisionList, KnowsWhatIsOpenAndWhy) {
  CollisionList list({{0.5, 1.0}, {1.2, 1.4}, {3.0, 3.5}}, kKeyframes_s);
  EXPECT_EQ(list.open_in(0), (std::vector<std::size_t>{0, 1}));
  EXPECT_TRUE(list.open_in(2).empty());
  correct(list[0], 0.2, 1.1);
  EXPECT_EQ(list.open_in(0), std::vector<std::size_t>{1});
  EXPECT_EQ(list.count_open(), 2u);
  list[1].is_beyond_limit = true;
  EXPECT_TRUE(list.any_without_way());
  list[2].is_beyond_limit = true;
  EXPECT_FALSE(list.any_without_way());
}

TEST(CollisionList, GroupsOpenCollisionsThatAreNear) {
  using Group = std::vector<std::size_t>;
  // The distances are 0.25, 0.5 and 0.25 seconds; a keyframe is between the last two.
  CollisionList list({{0.25, 0.5}, {0.75, 1.0}, {1.5, 1.875}, {2.125, 2.25}}, kKeyframes_s);
  EXPECT_EQ(list.open_near(0, 0.125), Group{0});
  EXPECT_EQ(list.open_near(0, 0.25), (Group{0, 1})) << "just near enough";
  EXPECT_EQ(list.open_near(0, 10.0), (Group{0, 1, 2})) << "those before the keyframe";
  EXPECT_EQ(list.open_near(1, 10.0), (Group{1, 2})) << "none before it";
  EXPECT_EQ(list.open_near(3, 10.0), Group{3});
  correct(list[1], 0.7, 1.1);
  EXPECT_EQ(list.open_near(0, 10.0), Group{0}) << "ends at one that is corrected";
}

TEST(CollisionList, AddsTheOpenCollisionsOfAPartAndNoOthers) {
  const motion::CubicPath path = path_along_x();
  CollisionList list({{0.5, 1.0}, {1.2, 1.4}, {4.5, 5.0}}, kKeyframes_s);
  correct(list[0], 0.2, 1.1);
  Problem part;
  part.path = path.around(0.0, 4.0);
  EXPECT_EQ(list.with_open_collisions(part).foreign_collisions,
            (std::vector<CollisionInterval>{{1.2, 1.4}}));
  part.path = path.around(2.0, 6.0);
  EXPECT_EQ(list.with_open_collisions(part).foreign_collisions,
            (std::vector<CollisionInterval>{{4.5, 5.0}}));
}

TEST(CollisionList, WidensOnlyCorrectionsThatReachIntoTheTime) {
  CollisionList list({{0.5, 1.0}, {2.5, 3.0}, {5.0, 5.5}}, kKeyframes_s);
  correct(list[0], 0.2, 1.5);
  correct(list[1], 1.8, 3.5);
  list.widen(2.0, 4.0, {1.0, 4.2});
  EXPECT_EQ(list[0].correction.t_end_s, 1.5);
  EXPECT_EQ(list[1].correction.t_begin_s, 1.0);
  EXPECT_EQ(list[1].correction.t_end_s, 4.2);
  EXPECT_EQ(list[2].correction.t_end_s, 0.0) << "it is open";
}

TEST(CollisionList, SetsTheRangesWithinAChangedPartOnly) {
  CollisionList list({{0.5, 1.0}, {1.2, 1.4}, {2.5, 3.0}, {5.0, 5.5}}, kKeyframes_s);
  correct(list[0], 0.2, 1.5);
  correct(list[2], 1.8, 3.5);
  correct(list[3], 4.0, 6.0);
  list.set_range({0.2, 3.5}, {0.4, 3.2});
  EXPECT_EQ(list[0].correction.t_begin_s, 0.4);
  EXPECT_EQ(list[0].correction.t_end_s, 3.2);
  EXPECT_EQ(list[1].correction.t_end_s, 0.0) << "it is open";
  EXPECT_EQ(list[2].correction.t_end_s, 3.2);
  EXPECT_EQ(list[3].correction.t_end_s, 6.0);
}

TEST(CollisionList, TellsTheIntervalsThatCorrectionsChanged) {
  const motion::CubicPath path = path_along_x();
  std::vector<motion::Keyframe> keyframes;
  for (const double time_s : kKeyframes_s) keyframes.push_back({time_s, path.pose(time_s)});
  const base::Deadline never = base::Deadline::never();
  const CorrectedPath corrected(path, keyframes, {}, never);
  CollisionList list({{0.5, 1.0}, {2.5, 3.0}, {5.0, 5.5}}, kKeyframes_s);
  EXPECT_EQ(list.corrected_legs(corrected), (std::vector<bool>{false, false, false}));
  correct(list[0], 0.2, 2.0);
  EXPECT_EQ(list.corrected_legs(corrected), (std::vector<bool>{true, false, false}));
  correct(list[2], 3.9, 6.0);
  EXPECT_EQ(list.corrected_legs(corrected), (std::vector<bool>{true, true, true}));
}

}  // namespace
}  // namespace camway::correction
