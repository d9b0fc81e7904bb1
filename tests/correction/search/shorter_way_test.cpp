// SPDX-License-Identifier: MIT
#include "daemon/correction/search/shorter_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/correction/search_scene.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using geometry::Vec3;

const BallMotion kBall{.radius_m = 0.2, .from_W = {0, 0, -4}, .to_W = {0, 0, 4}};

LatticeResult way_of_cost(double cost_m) {
  LatticeResult way;
  way.cost_m = cost_m;
  way.points = 100;
  return way;
}

TEST(ShorterWay, IsLookedForOnlyWhereTheFirstIsLong) {
  EXPECT_FALSE(shorter_way(kBall, way_of_cost(8.0)));
  EXPECT_FALSE(shorter_way(kBall, way_of_cost(12.0)));
  EXPECT_TRUE(shorter_way(kBall, way_of_cost(16.0)));
}

TEST(ShorterWay, IsNotLookedForWhereAFinerLatticeWouldRunOut) {
  LatticeResult way = way_of_cost(20.0);
  way.points = 3000;
  EXPECT_FALSE(shorter_way(kBall, way));
}

TEST(ShorterWay, LimitsTheSearchByWhatTheFirstTook) {
  const BallMotion search = shorter_way(kBall, way_of_cost(20.0)).value();
  EXPECT_EQ(search.from_W, kBall.from_W);
  EXPECT_EQ(search.to_W, kBall.to_W);
  EXPECT_EQ(search.radius_m, kBall.radius_m);
  EXPECT_LT(search.max_cost_m, 20.0);
  EXPECT_GT(search.max_points, 100U);
  EXPECT_LT(search.max_points, 1000U);
  EXPECT_LT(search.coarseness, kBall.coarseness);
}

/// The first way on the coarse lattices, and its largest distance from the straight line.
LatticeResult coarse_way(const FreeSpace& space, const BallMotion& ball) {
  LatticeResult way;
  const auto use = [&](const LatticeResult& found) {
    way = found;
    return true;
  };
  for_each_lattice_way(space, ball, Lattices::kCoarse, {}, {.use = use}, base::Deadline::never());
  return way;
}

double farthest_m(const LatticeResult& way) {
  double most_m = 0.0;
  for (const Vec3& place_W : way.way_W)
    most_m = std::max(most_m, std::hypot(place_W[0], place_W[1]));
  return most_m;
}

TEST(ShorterWay, LeadsThroughAWindowThatCoarseLatticesMiss) {
  scene::Mesh mesh;
  testing::add_wall_with_window(mesh);
  // A low hall, so that the first search takes few points.
  testing::add_cuboid(mesh, {-20, -1.5, -8}, {20, -1.4, 8});
  testing::add_cuboid(mesh, {-20, 2.4, -8}, {20, 2.5, 8});
  const testing_search::SearchScene scene(std::move(mesh));
  const FreeSpace space = scene.space();
  const LatticeResult first = coarse_way(space, kBall);
  ASSERT_FALSE(first.way_W.empty());
  EXPECT_GT(farthest_m(first), 6.0);
  const std::optional<BallMotion> search = shorter_way(kBall, first);
  ASSERT_TRUE(search);
  const LatticeResult shorter = coarse_way(space, *search);
  ASSERT_FALSE(shorter.way_W.empty());
  EXPECT_LT(farthest_m(shorter), 2.0);
}

}  // namespace
}  // namespace camway::correction
