// SPDX-License-Identifier: MIT
#include "daemon/correction/search/tree_search.h"

#include <gtest/gtest.h>

#include "tests/correction/search_scene.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file
using base::Deadline;

constexpr double kTreeMargin_m = 0.002;

SignedPose signed_at(const Vec3& position) { return {position, Vec4::UnitX()}; }

TreeOptions options_from(const SignedPose& from, const SignedPose& to, std::uint64_t seed) {
  TreeOptions options;
  options.about_W = {from.position, to.position};
  options.interpolated = {motion::unsigned_pose(from), motion::unsigned_pose(to)};
  options.reach_m = 0.6;
  options.margin_m = kTreeMargin_m;
  options.seed = seed;
  return options;
}

/// A near quadrilateral of 0.4 m × 0.3 m before a gap of 0.35 m: it has to roll.
struct Slot {
  SearchScene scene{wall_with_gap(-0.175, 0.175),
                    motion::Body(motion::Camera{2.0 * std::atan(1.0), 2.0 * std::atan(0.75), 0.2})};
  SignedPose from = signed_at({0, 0, 1.5});
  SignedPose to = signed_at({0, 0, -1.5});
};

void expect_way(const SearchScene& scene, const Guide& way, const SignedPose& from,
                const SignedPose& to) {
  ASSERT_GE(way.size(), 2U);
  EXPECT_TRUE(same({way.front(), way.back()}, {from, to}));
  EXPECT_TRUE(is_proved_free(scene, way, kTreeMargin_m));
  EXPECT_GE(least_distance_m(scene, scene.space(), way, 5e-3), kTreeMargin_m);
  for (std::size_t i = 1; i < way.size(); ++i) {
    EXPECT_NEAR(way[i].orientation.norm(), 1.0, 1e-12);
    // Less than half a turn, by the way that the signs say.
    EXPECT_GT(way[i - 1].orientation.dot(way[i].orientation), 0.0);
  }
}

TEST(TreeWay, StraightWhereThatIsFree) {
  const SearchScene scene(wall_with_gap(-1, 1));
  FreeSpace space = scene.space();
  const SignedPose from = signed_at({0, 0, 1});
  const SignedPose to = signed_at({0.3, 0, -1});
  const Guide way = tree_way(space, from, to, options_from(from, to, 1), Deadline::never()).guide;
  EXPECT_TRUE(same(way, {from, to}));
}

TEST(TreeWay, TurnsToGetThroughWithAnySeed) {
  const Slot slot;
  Guide first;
  int different = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    FreeSpace space = slot.scene.space();
    const TreeOptions options = options_from(slot.from, slot.to, seed);
    const Guide way = tree_way(space, slot.from, slot.to, options, Deadline::never()).guide;
    expect_way(slot.scene, way, slot.from, slot.to);
    FreeSpace again = slot.scene.space();
    EXPECT_TRUE(same(way, tree_way(again, slot.from, slot.to, options, Deadline::never()).guide));
    if (first.empty()) first = way;
    different += same(first, way) ? 0 : 1;
  }
  EXPECT_GE(different, 6);
}

TEST(TreeWay, KeepsTheClearance) {
  Slot slot;
  slot.scene.detect.clearance_m = 0.015;
  FreeSpace space = slot.scene.space();
  const Guide way =
      tree_way(space, slot.from, slot.to, options_from(slot.from, slot.to, 1), Deadline::never())
          .guide;
  expect_way(slot.scene, way, slot.from, slot.to);
  EXPECT_GE(least_distance_m(slot.scene, space, way, 5e-3), 0.015 + kTreeMargin_m);
}

// The end is the same orientation with the other sign: there it has to arrive after a full turn.
TEST(TreeWay, ArrivesWithTheSignThatWasAskedFor) {
  const SearchScene scene(wall_with_gap(-1, 1));
  const SignedPose from = signed_at({0, 0, 1});
  SignedPose to = signed_at({0, 0, -1});
  to.orientation = -to.orientation;
  TreeOptions options = options_from(from, to, 1);
  options.largest_turn_rad = 2.0 * std::numbers::pi;
  FreeSpace space = scene.space();
  // Half way no orientation is between the two, so it takes samples that are turned.
  const SignedPose half{{0, 0, -0.5}, Vec4(0, 1, 0, 0)};
  options.about_W = {from.position, half.position};
  const Guide first = tree_way(space, from, half, options, Deadline::never()).guide;
  expect_way(scene, first, from, half);
  const Guide second = tree_way(space, half, to, options, Deadline::never()).guide;
  expect_way(scene, second, half, to);
}

TEST(TreeWay, GivesUpWithinItsBounds) {
  const Slot slot;
  SearchScene closed(wall_with_gap(0, 0), slot.scene.body);
  FreeSpace space = closed.space();
  TreeOptions options = options_from(slot.from, slot.to, 1);
  options.max_samples = 300;
  EXPECT_TRUE(tree_way(space, slot.from, slot.to, options, Deadline::never()).guide.empty());
  // Where there is a way, too: it takes more than one sample, or a moment.
  FreeSpace open = slot.scene.space();
  options.max_samples = 1;
  EXPECT_TRUE(tree_way(open, slot.from, slot.to, options, Deadline::never()).guide.empty());
  options.max_samples = 3000;
  EXPECT_TRUE(tree_way(open, slot.from, slot.to, options, Deadline::after_s(0.0)).guide.empty());
}

// Places further from the way than the reach are not tried: the gap is 3 m beside it.
TEST(TreeWay, LooksAlongTheWayThatItIsGiven) {
  const SearchScene scene(wall_with_gap(3.0, 4.0));
  const SignedPose from = signed_at({0, 0, 1});
  const SignedPose to = signed_at({0, 0, -1});
  TreeOptions options = options_from(from, to, 1);
  options.max_samples = 400;
  FreeSpace space = scene.space();
  options.about_W = {from.position, {3.5, 0, 0.5}, {3.5, 0, -0.5}, to.position};
  expect_way(scene, tree_way(space, from, to, options, Deadline::never()).guide, from, to);
}

}  // namespace
}  // namespace camway::correction
