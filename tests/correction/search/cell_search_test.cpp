// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/correction/search_scene.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file
using collision::Deadline;

constexpr double kBall_m = 0.02;
constexpr std::size_t kEnough = 400'000;  // cells
// Of the ball's radius: more than distances of a few metres are rounded by.
constexpr double kRounding = 1e-9;

struct Hole {
  double x_m, y_m, half_m;
};

/// A closed room of 2.4 x 2.4 x 3 m, and a thin wall across it at z = 0 with square holes, one
/// beside the other in the direction of x.
scene::Mesh divided_room(const std::vector<Hole>& holes) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-1.3, -1.3, 1.5}, {1.3, 1.3, 1.6});
  testing::add_cuboid(mesh, {-1.3, -1.3, -1.6}, {1.3, 1.3, -1.5});
  for (const double side_m : {-1.25, 1.25}) {
    testing::add_cuboid(mesh, {side_m - 0.05, -1.3, -1.5}, {side_m + 0.05, 1.3, 1.5});
    testing::add_cuboid(mesh, {-1.2, side_m - 0.05, -1.5}, {1.2, side_m + 0.05, 1.5});
  }
  double x_m = -1.2;
  for (const Hole& hole : holes) {
    const double begin_m = hole.x_m - hole.half_m;
    const double end_m = hole.x_m + hole.half_m;
    testing::add_cuboid(mesh, {x_m, -1.2, -0.01}, {begin_m, 1.2, 0.01});
    testing::add_cuboid(mesh, {begin_m, -1.2, -0.01}, {end_m, hole.y_m - hole.half_m, 0.01});
    testing::add_cuboid(mesh, {begin_m, hole.y_m + hole.half_m, -0.01}, {end_m, 1.2, 0.01});
    x_m = end_m;
  }
  testing::add_cuboid(mesh, {x_m, -1.2, -0.01}, {1.2, 1.2, 0.01});
  return mesh;
}

struct RoomCase {
  explicit RoomCase(const std::vector<Hole>& holes, const Quat& turn_W = Quat::Identity())
      : scene(turned(divided_room(holes), turn_W)),
        from_W(turn_W * Vec3(-0.3, 0.2, 1.1)),
        to_W(turn_W * Vec3(0.4, -0.1, -1.2)) {}

  static scene::Mesh turned(scene::Mesh mesh, const Quat& turn_W) {
    for (Vec3& vertex : mesh.vertices) vertex = turn_W * vertex;
    return mesh;
  }

  [[nodiscard]] CellResult way(const CellOptions& options,
                               const Deadline& deadline = Deadline::never()) const {
    return cell_way(scene.space(), from_W, to_W, options, deadline);
  }

  SearchScene scene;
  Vec3 from_W;
  Vec3 to_W;
};

CellOptions options_of(double smallest_m, std::size_t max_cells = kEnough) {
  return {kBall_m, smallest_m, max_cells, /*comfort_m=*/0.3};
}

// The oracle measures each leg against every triangle.
void expect_free_way(const RoomCase& c, const CellResult& result) {
  ASSERT_GE(result.way_W.size(), 2U);
  EXPECT_FALSE(result.exhausted);
  EXPECT_EQ(result.way_W.front(), c.from_W);
  EXPECT_EQ(result.way_W.back(), c.to_W);
  for (std::size_t i = 1; i < result.way_W.size(); ++i) {
    const double gap_m = c.scene.least_m({result.way_W[i - 1], result.way_W[i], result.way_W[i]});
    EXPECT_GE(gap_m, kBall_m * (1.0 - kRounding)) << "leg " << i;
  }
}

TEST(CellWay, FindsSmallHolesAnywhereInAWall) {
  std::mt19937_64 random = testing::seeded(5201);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  for (int run = 0; run < 12; ++run) {
    SCOPED_TRACE(run);
    const Hole hole{place(random), place(random), (2.2 + 0.2 * run) * kBall_m};
    const RoomCase c({hole}, run % 2 == 0 ? Quat::Identity() : testing::random_rotation(random));
    expect_free_way(c, c.way(options_of(0.1 * kBall_m)));
  }
}

TEST(CellWay, SaysWhenThereIsNone) {
  for (const double half_m : {0.0, 0.9 * kBall_m}) {
    const CellResult result = RoomCase({{0.1, 0.2, half_m}}).way(options_of(kBall_m));
    EXPECT_TRUE(result.way_W.empty());
    EXPECT_TRUE(result.exhausted) << result.cells;
  }
}

// However large the rest is, and from whichever end: about the box that is shut, of bare walls.
TEST(CellWay, IsOverWhenTheSmallerEndWasLookedAt) {
  scene::Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 center = Vec3::Zero();
      Vec3 half = Vec3::Constant(0.55);
      center[axis] = 0.525 * side;
      half[axis] = 0.025;
      testing::add_cuboid(mesh, center - half, center + half);
    }
  }
  std::mt19937_64 random = testing::seeded(5202);
  scene::Mesh rest = scattered_cuboids(random, 300, 0.1);
  for (Vec3& vertex : rest.vertices) vertex = 3.0 * vertex + Vec3(6, 0, 0);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), rest.vertices.begin(), rest.vertices.end());
  for (auto triangle : rest.triangles) {
    for (std::uint32_t& vertex : triangle) vertex += first;
    mesh.triangles.push_back(triangle);
  }
  const SearchScene scene(mesh);
  const Vec3 inside_W(0.1, 0.2, -0.1);
  const Vec3 outside_W(2.0, 0.1, 0.3);
  for (const bool is_at_end : {false, true}) {
    const CellResult result =
        cell_way(scene.space(), is_at_end ? outside_W : inside_W, is_at_end ? inside_W : outside_W,
                 options_of(0.5 * kBall_m), Deadline::never());
    EXPECT_TRUE(result.way_W.empty());
    EXPECT_TRUE(result.exhausted) << result.cells;
    ASSERT_TRUE(result.pocket);
    EXPECT_EQ(result.pocket->is_at_end, is_at_end);
    EXPECT_TRUE(result.pocket->reached_W.contains(inside_W));
    EXPECT_LT(result.pocket->reached_W.sizes().maxCoeff(), 1.0);
    EXPECT_LT(result.cells, 50'000U);
  }
}

// Fewer cells than the small hole would take.
TEST(CellWay, LeadsThroughTheWiderHole) {
  const Vec3 small_W(-0.6, 0.1, 0.0);
  const RoomCase c({{small_W.x(), small_W.y(), 2.0 * kBall_m}, {0.5, 0.0, 0.3}});
  const CellResult result = c.way(options_of(0.1 * kBall_m, 50'000));
  expect_free_way(c, result);
  for (const Vec3& point : result.way_W) EXPECT_GT((point - small_W).norm(), 0.1);
}

// In front of the wall no way is better than another but for the room that it has.
TEST(CellWay, KeepsToWhereThereIsRoom) {
  const RoomCase c({{0.0, 0.0, 0.6}});
  const CellResult result = c.way(options_of(0.1 * kBall_m));
  expect_free_way(c, result);
  for (const Vec3& point : result.way_W)
    EXPECT_GT(c.scene.least_m({point, point, point}), 5.0 * kBall_m);
}

TEST(CellWay, LeadsRoundTheOutside) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-1, -1, -0.05}, {1, 1, 0.05});
  const SearchScene scene(mesh);
  const CellResult result =
      cell_way(scene.space(), {0, 0, 1}, {0, 0, -1}, options_of(kBall_m), Deadline::never());
  ASSERT_FALSE(result.way_W.empty());
  for (std::size_t i = 1; i < result.way_W.size(); ++i)
    EXPECT_GE(scene.least_m({result.way_W[i - 1], result.way_W[i], result.way_W[i]}),
              kBall_m * (1.0 - kRounding));
}

TEST(CellWay, IsTheSameEachTime) {
  const RoomCase c({{0.31, -0.42, 2.5 * kBall_m}});
  const CellResult once = c.way(options_of(0.1 * kBall_m));
  const CellResult twice = c.way(options_of(0.1 * kBall_m));
  EXPECT_FALSE(once.way_W.empty());
  EXPECT_EQ(once.way_W, twice.way_W);
  EXPECT_EQ(once.cells, twice.cells);
}

TEST(CellWay, StopsAtItsLimits) {
  const RoomCase c({{0.31, -0.42, 1.2 * kBall_m}});
  const CellResult few = c.way(options_of(0.1 * kBall_m, 1000));
  EXPECT_TRUE(few.way_W.empty());
  EXPECT_FALSE(few.exhausted);
  EXPECT_LT(few.cells, 1010U);
  const CellResult late = c.way(options_of(0.1 * kBall_m), Deadline::after_s(0.0));
  EXPECT_TRUE(late.way_W.empty());
  EXPECT_FALSE(late.exhausted);
}

}  // namespace
}  // namespace camway::correction
