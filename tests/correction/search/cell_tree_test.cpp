// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "tests/correction/cell_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file

constexpr double kTreeBall_m = 0.05;
// Larger than the rounding of distances of a few metres.
constexpr double kTreeRounding_m = 1e-9;
const CellOptions kTreeOptions{.ball_radius_m = kTreeBall_m, .smallest_m = 0.1};

geometry::Box tree_box(const CellTree& tree, std::uint32_t index) {
  const Vec3 center_W = tree.center_W(tree[index]);
  const double half_m = 0.5 * tree.side_m(tree[index].level);
  return {center_W.array() - half_m, center_W.array() + half_m};
}

// The oracle measures the corners and the middle of the cell against every triangle. A cell is
// blocked only if the ball is larger than the cell, as the search knows nothing of insides; and a
// small ball leaves little between what is free and what is proved free.
TEST(CellTree, IsRightAboutFreeAndBlockedCells) {
  testing::Random random(5301);
  const scene::Mesh mesh = scattered_cuboids(random, 4, 0.4);
  int free = 0;
  int blocked = 0;
  for (const double ball_m : {0.01, 0.25}) {
    const CellScene c(mesh, {.ball_radius_m = ball_m, .smallest_m = 0.05});
    for (std::uint32_t i = 0; i < c.tree.size(); ++i) {
      if (c.tree[i].is_divided() || c.tree[i].state == CellState::kMixed) continue;
      const bool is_free = c.tree[i].state == CellState::kFree;
      ++(is_free ? free : blocked);
      const geometry::Box box = tree_box(c.tree, i);
      for (int point = 0; point < 9; ++point) {
        const Vec3 point_W =
            point < 8 ? box.corner(static_cast<geometry::Box::CornerType>(point)) : box.center();
        const double gap_m = c.scene.distance_m(point_W) - ball_m;
        EXPECT_EQ(gap_m >= (is_free ? -kTreeRounding_m : kTreeRounding_m), is_free) << i;
      }
    }
  }
  EXPECT_GT(free, 100);
  EXPECT_GT(blocked, 10);
}

// The gap of a body that does not turn grows by no more than the body moves. Here it is the height
// above a slanted plane, of which the tree knows nothing else.
TEST(CellTree, IsRightAboutCellsThatAreFreeForABody) {
  const Vec3 up = Vec3(1, 2, 3).normalized();
  CellOptions options{.smallest_m = 0.05};
  options.body_gap_m = [&](const Vec3& center_W, double up_to_m) {
    return std::min(up.dot(center_W), up_to_m);
  };
  const SearchScene empty(scene::Mesh{});
  const FreeSpace space = empty.space();
  CellTree tree(space, options, {Vec3::Constant(-1.0), Vec3::Constant(1.0)});
  std::size_t free = 0;
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    if (tree[i].state == CellState::kMixed && tree.may_divide(tree[i])) tree.divide(i);
    EXPECT_NE(tree[i].state, CellState::kBlocked);
    if (tree[i].state != CellState::kFree) continue;
    ++free;
    const geometry::Box box = tree_box(tree, i);
    for (int corner = 0; corner < 8; ++corner) {
      EXPECT_GE(up.dot(box.corner(static_cast<geometry::Box::CornerType>(corner))),
                -kTreeRounding_m);
    }
  }
  EXPECT_GT(free, 1000U);
}

// The oracle compares a cell with all others.
TEST(CellTree, VisitsTheUndividedCellsAtItsFaces) {
  testing::Random random(5302);
  const CellScene c(scattered_cuboids(random, 3, 0.4), kTreeOptions);
  std::vector<std::uint32_t> undivided;
  for (std::uint32_t i = 0; i < c.tree.size(); ++i) {
    if (!c.tree[i].is_divided()) undivided.push_back(i);
  }
  ASSERT_GT(undivided.size(), 300U);
  for (int run = 0; run < 100; ++run) {
    const std::uint32_t cell = undivided[random() % undivided.size()];
    std::set<std::uint32_t> expected;
    for (const std::uint32_t other : undivided) {
      // Sides are powers of two, so the corners are exact. Two cells meet in a face, or a part of
      // one, if what they have in common has length along just two axes.
      const Vec3 common = tree_box(c.tree, cell).intersection(tree_box(c.tree, other)).sizes();
      if (common.minCoeff() == 0.0 && (common.array() > 0.0).count() == 2) expected.insert(other);
    }
    std::vector<std::uint32_t> visited;
    c.tree.for_each_neighbour(cell, [&](std::uint32_t next) { visited.push_back(next); });
    EXPECT_EQ(std::set(visited.begin(), visited.end()), expected) << cell;
    EXPECT_EQ(visited.size(), expected.size()) << "each is visited once";
  }
}

TEST(CellTree, FindsTheFreeCellThatHoldsAPoint) {
  testing::Random random(5303);
  const SearchScene scene(scattered_cuboids(random, 12, 0.7));
  const FreeSpace space = scene.space();
  CellTree tree(space, kTreeOptions, {Vec3::Constant(-1.0), Vec3::Constant(1.0)});
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  int found = 0;
  for (int run = 0; run < 200; ++run) {
    const Vec3 point_W(place(random), place(random), place(random));
    const std::optional<std::uint32_t> cell = tree.free_cell_at(point_W);
    if (!cell) continue;  // the point is in or near an obstacle
    ++found;
    EXPECT_EQ(tree[*cell].state, CellState::kFree);
    EXPECT_FALSE(tree[*cell].is_divided());
    EXPECT_TRUE(tree_box(tree, *cell).contains(point_W));
    EXPECT_GE(scene.distance_m(point_W), kTreeBall_m - kTreeRounding_m);
  }
  EXPECT_GT(found, 50);
}

TEST(CellTree, FindsNoFreeCellWhereTheBallCollides) {
  const SearchScene scene(wall_with_gap(2.0, 3.0));
  const FreeSpace space = scene.space();
  CellTree tree(space, kTreeOptions, {Vec3::Constant(-1.0), Vec3::Constant(1.0)});
  EXPECT_FALSE(tree.free_cell_at({0.1, 0.2, 0.06}));
  EXPECT_TRUE(tree.free_cell_at({0.1, 0.2, 0.9}));
}

TEST(CellTree, DividesNoFurtherThanTheSmallestSide) {
  testing::Random random(5304);
  const CellScene c(scattered_cuboids(random, 3, 0.4), kTreeOptions);
  double least_m = 2.0;
  for (std::uint32_t i = 0; i < c.tree.size(); ++i)
    least_m = std::min(least_m, c.tree.side_m(c.tree[i].level));
  // Sides are 2 m, 1 m, 0.5 m and so on; half of 0.125 m would be too small.
  EXPECT_EQ(least_m, 0.125);
}

TEST(EndSet, HoldsEachEndByItself) {
  EndSet ends;
  EXPECT_TRUE(ends.empty());
  ends.add(1);
  EXPECT_FALSE(ends.has(0));
  EXPECT_TRUE(ends.has(1));
  ends.add(0);
  ends.remove(1);
  EXPECT_TRUE(ends.has(0));
  EXPECT_FALSE(ends.has(1));
  EXPECT_FALSE(ends.empty());
}

}  // namespace
}  // namespace camway::correction
