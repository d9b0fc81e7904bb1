// SPDX-License-Identifier: MIT
#include "daemon/correction/search/lattice_ways.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/correction/search_scene.h"

namespace camway::correction {
namespace {

using geometry::Vec3;

TEST(LatticeWays, CoarserLatticesJoinTheSameEndsByFewerPoints) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-2, -3, -0.1}, {2, 3, 0.1});
  const testing_search::SearchScene scene(std::move(mesh));
  const FreeSpace space = scene.space();
  std::vector<std::size_t> points;
  for (const double coarseness : {1.0, 2.0}) {
    const BallMotion ball{
        .radius_m = 0.2, .from_W = {0, 0, -3}, .to_W = {0, 0, 3}, .coarseness = coarseness};
    std::vector<Vec3> way_W;
    const auto use = [&](const LatticeResult& found) {
      way_W = found.way_W;
      return true;
    };
    points.push_back(for_each_lattice_way(space, ball, Lattices::kCoarse, {}, {.use = use},
                                          base::Deadline::never()));
    ASSERT_GE(way_W.size(), 2U);
    EXPECT_EQ(way_W.front(), ball.from_W);
    EXPECT_EQ(way_W.back(), ball.to_W);
  }
  EXPECT_LT(2 * points[1], points[0]);
}

}  // namespace
}  // namespace camway::correction
