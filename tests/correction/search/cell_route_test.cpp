// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_route.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/correction/cell_scene.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file

constexpr double kRouteBall_m = 0.02;
const CellOptions kRouteOptions{
    .ball_radius_m = kRouteBall_m, .smallest_m = 0.06, .comfort_m = 0.5};
// Less than the gap of any free cell, so that only the length counts.
constexpr double kNoComfort_m = 1e-12;
// A part of a length of a few metres that is larger than its rounding, in whatever order its steps
// are added.
constexpr double kRouteRounding = 1e-12;

const Vec3 kAbove_W(0.1, 0.1, 0.7);
const Vec3 kBelow_W(0.1, 0.1, -0.7);

/// A wall across the cube at z = 0 with a narrow gap at x = 0.5 and a wide one at x = -0.5. All
/// free cells were reached.
struct RouteScene {
  RouteScene() : cells(wall(), kRouteOptions) {
    cells.reach(0, [](const Vec3&) { return true; });
    start = *cells.tree.free_cell_at(kAbove_W);
    goal = *cells.tree.free_cell_at(kBelow_W);
  }

  static scene::Mesh wall() {
    scene::Mesh mesh;
    testing::add_cuboid(mesh, {-30, -30, -0.05}, {-0.8, 30, 0.05});
    testing::add_cuboid(mesh, {-0.2, -30, -0.05}, {0.375, 30, 0.05});
    testing::add_cuboid(mesh, {0.625, -30, -0.05}, {30, 30, 0.05});
    return mesh;
  }

  [[nodiscard]] std::vector<Vec3> way(double comfort_m) const {
    return cheapest_way(cells.tree, start, goal, comfort_m);
  }

  CellScene cells;
  std::uint32_t start = kNoCell;
  std::uint32_t goal = kNoCell;
};

double route_length_m(const std::vector<Vec3>& way_W) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < way_W.size(); ++i) length_m += (way_W[i] - way_W[i - 1]).norm();
  return length_m;
}

/// Returns the x at which a way first is below the middle of the wall.
double x_in_wall_m(const std::vector<Vec3>& way_W) {
  for (const Vec3& point_W : way_W) {
    if (point_W.z() < 0.0) return point_W.x();
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The algorithm of Bellman and Ford: relaxes all steps until nothing changes.
double shortest_m(const CellTree& tree, std::uint32_t start, std::uint32_t goal) {
  std::vector<double> length_m(tree.size(), std::numeric_limits<double>::infinity());
  length_m[start] = 0.0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::uint32_t i = 0; i < tree.size(); ++i) {
      if (tree[i].reached.empty()) continue;
      tree.for_each_neighbour(i, [&](std::uint32_t next) {
        if (tree[next].reached.empty()) return;
        const double by_m =
            length_m[i] + (tree.center_W(tree[i]) - tree.center_W(tree[next])).norm();
        if (!(by_m < length_m[next])) return;
        length_m[next] = by_m;
        changed = true;
      });
    }
  }
  return length_m[goal];
}

// The oracle measures each leg against every triangle.
TEST(CheapestWay, IsFreeAndJoinsTheMiddlesOfItsEnds) {
  const RouteScene c;
  for (const double comfort_m : {kNoComfort_m, 0.5}) {
    const std::vector<Vec3> way_W = c.way(comfort_m);
    ASSERT_GE(way_W.size(), 3U);
    EXPECT_EQ(way_W.front(), c.cells.tree.center_W(c.cells.tree[c.start]));
    EXPECT_EQ(way_W.back(), c.cells.tree.center_W(c.cells.tree[c.goal]));
    for (std::size_t i = 1; i < way_W.size(); ++i) {
      const double gap_m = c.cells.scene.least_m({way_W[i - 1], way_W[i], way_W[i]});
      EXPECT_GE(gap_m, kRouteBall_m * (1.0 - kRouteRounding)) << "leg " << i;
    }
  }
}

TEST(CheapestWay, IsTheShortestWhereRoomDoesNotCount) {
  const RouteScene c;
  const double least_m = shortest_m(c.cells.tree, c.start, c.goal);
  EXPECT_NEAR(route_length_m(c.way(kNoComfort_m)), least_m, kRouteRounding * least_m);
}

TEST(CheapestWay, LeadsFartherRoundWhereThereIsMoreRoom) {
  const RouteScene c;
  EXPECT_GT(x_in_wall_m(c.way(kNoComfort_m)), 0.0) << "through the narrow gap";
  EXPECT_LT(x_in_wall_m(c.way(0.5)), 0.0) << "through the wide gap";
}

TEST(CheapestWay, LeadsOnlyThroughCellsThatWereReached) {
  RouteScene c;
  // The cells in and near the narrow gap are taken back.
  c.cells.for_each_free([&](std::uint32_t i, const Vec3& center_W) {
    if (center_W.x() > 0.0 && std::abs(center_W.z()) < 0.1) c.cells.tree[i].reached.remove(0);
  });
  EXPECT_LT(x_in_wall_m(c.way(kNoComfort_m)), 0.0);
}

TEST(CheapestWay, IsOnePointFromACellToItself) {
  const RouteScene c;
  EXPECT_EQ(cheapest_way(c.cells.tree, c.start, c.start, 0.5).size(), 1U);
}

}  // namespace
}  // namespace camway::correction
