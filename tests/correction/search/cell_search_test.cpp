// SPDX-License-Identifier: MIT
#include "daemon/correction/search/cell_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/correction/search_scene.h"
#include "tests/support/random.h"
#include "tests/support/sanitizer.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file
using base::Deadline;
using geometry::Bounds;

constexpr double kBall_m = 0.02;
constexpr std::size_t kEnoughCells = 400'000;  // cells
// A part of the ball's radius that is larger than the rounding of distances of a few metres.
constexpr double kCellRounding = 1e-9;

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

CellOptions options_of(double smallest_m, std::size_t max_cells = kEnoughCells) {
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
    EXPECT_GE(gap_m, kBall_m * (1.0 - kCellRounding)) << "leg " << i;
  }
}

TEST(CellWay, FindsSmallHolesAnywhereInAWall) {
  testing::Random random(5201);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  for (int run = 0; run < 12; ++run) {
    SCOPED_TRACE(run);
    const Hole hole{place(random), place(random), (2.2 + 0.2 * run) * kBall_m};
    const RoomCase c({hole}, run % 2 == 0 ? Quat::Identity() : random.rotation());
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

/// Points of a grid in a box, each joined to those beside it where the straight way between the two
/// keeps `keep_m` away from all triangles: what a ball can do at the least.
class GridOfRoom {
 public:
  GridOfRoom(const SearchScene& scene, const geometry::Box& within, double spacing_m, double keep_m)
      : low_W_(within.min()), spacing_m_(spacing_m) {
    for (int axis = 0; axis < 3; ++axis)
      count_[axis] = 1 + static_cast<int>(within.sizes()[axis] / spacing_m);
    for (int i = 0; i < count_.prod(); ++i)
      has_room_.push_back(scene.distance_m(point_W(i)) >= keep_m + 0.5 * spacing_m);
  }

  [[nodiscard]] Vec3 point_W(int i) const {
    const Eigen::Array3d at(i % count_[0], i / count_[0] % count_[1], i / count_[0] / count_[1]);
    return low_W_.array() + spacing_m_ * at;
  }

  /// The parts in which all points are joined, by number; -1 where there is no room.
  [[nodiscard]] std::vector<int> parts() const {
    std::vector<int> part(has_room_.size(), -1);
    int parts = 0;
    for (std::size_t first = 0; first < part.size(); ++first) {
      if (part[first] >= 0 || !has_room_[first]) continue;
      std::vector<std::size_t> open = {first};
      part[first] = parts;
      while (!open.empty()) {
        const std::size_t at = open.back();
        open.pop_back();
        for_each_beside(static_cast<int>(at), [&](std::size_t next) {
          if (part[next] >= 0 || !has_room_[next]) return;
          part[next] = parts;
          open.push_back(next);
        });
      }
      ++parts;
    }
    return part;
  }

 private:
  template <class Visit>
  void for_each_beside(int i, const Visit& visit) const {
    const std::array<int, 3> stride = {1, count_[0], count_[0] * count_[1]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int at = i / stride[axis] % count_[static_cast<Eigen::Index>(axis)];
      if (at > 0) visit(static_cast<std::size_t>(i - stride[axis]));
      if (at + 1 < count_[static_cast<Eigen::Index>(axis)])
        visit(static_cast<std::size_t>(i + stride[axis]));
    }
  }

  Vec3 low_W_;
  double spacing_m_;
  Eigen::Array3i count_;
  std::vector<bool> has_room_;
};

std::size_t any_with_room(const std::vector<int>& parts, testing::Random& random) {
  while (true) {
    const std::size_t i = random() % parts.size();
    if (parts[i] >= 0) return i;
  }
}

/// Boxes without lids and walls that stand apart by more or less than the ball: much is nearly
/// closed.
scene::Mesh plates_with_slits(testing::Random& random) {
  std::uniform_real_distribution<double> place(-0.6, 0.6);
  std::uniform_real_distribution<double> length(0.5, 1.6);
  std::uniform_int_distribution<int> axis(0, 2);
  std::uniform_int_distribution<int> count(10, 22);
  scene::Mesh mesh;
  for (int i = count(random); i > 0; --i) {
    const Quat turn_W = i % 3 == 0 ? random.rotation() : Quat::Identity();
    Vec3 half = 0.5 * Vec3(length(random), length(random), length(random));
    half[axis(random)] = 0.002;
    const Vec3 center(place(random), place(random), place(random));
    scene::Mesh plate;
    testing::add_cuboid(plate, -half, half);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& vertex : plate.vertices) mesh.vertices.push_back(center + turn_W * vertex);
    for (auto triangle : plate.triangles) {
      for (std::uint32_t& vertex : triangle) vertex += first;
      mesh.triangles.push_back(triangle);
    }
  }
  return mesh;
}

// Cells that are spared must not be those that a way leads through: where a grid finds one for a
// ball with room to spare, the search does not say that there is none.
TEST(CellWay, IsExhaustedOnlyWhereThereIsNoWay) {
  testing::Random random(5203);
  constexpr double kSpacing_m = 0.05;
  constexpr std::size_t kAFewCells = 15'000;  // a wrong claim takes fewer than a right one
  constexpr double kSmallest_m = 0.125 * kSpacing_m;
  // A smallest cell about a point of the way is free if its middle, up to half of its diagonal from
  // the point, has the distance that the search takes for room for the ball and that half. Its side
  // is less than twice `kSmallest_m`, as halves of it would be too small.
  const double half_m = 0.5 * std::numbers::sqrt3 * 2.0 * kSmallest_m;
  const double to_spare_m = (kBall_m + half_m) / FreeSpace::kBallShare + half_m - kBall_m;
  int ways = 0;
  int without = 0;
  const int runs = testing::runs(8);
  for (int run = 0; run < runs; ++run) {
    SCOPED_TRACE(run);
    const SearchScene scene(plates_with_slits(random));
    Bounds bounds{Vec3::Constant(-0.6), Vec3::Constant(0.6)};
    const GridOfRoom grid(scene, {bounds.min_W, bounds.max_W}, kSpacing_m, kBall_m + to_spare_m);
    bounds = bounds.shrunk_by(-2.0 * kBall_m);
    const FreeSpace space(
        {collision::Obstacles(scene.index).within(bounds), scene.body, scene.detect});
    const std::vector<int> parts = grid.parts();
    ASSERT_GE(*std::ranges::max_element(parts), 0) << "no point has room";
    for (int pair = 0; pair < 40; ++pair) {
      const std::size_t from = any_with_room(parts, random);
      std::size_t to = any_with_room(parts, random);
      // Some pairs are in two parts, if there are two, so that there is no way between them.
      for (int i = 0; i < 100 && pair % 20 == 0 && parts[from] == parts[to]; ++i)
        to = any_with_room(parts, random);
      const CellResult found =
          cell_way(space, grid.point_W(static_cast<int>(from)), grid.point_W(static_cast<int>(to)),
                   options_of(kSmallest_m, kAFewCells), Deadline::never());
      EXPECT_FALSE(found.exhausted && parts[from] == parts[to]) << from << " to " << to;
      ways += found.way_W.empty() ? 0 : 1;
      without += found.exhausted ? 1 : 0;
    }
  }
  EXPECT_GT(ways, 8 * runs);
  EXPECT_GT(without, 0);
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
  testing::Random random(5202);
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

/// Adds the walls of a room, with a square hole of half the side `hole_m` in that at its largest x.
void add_room(scene::Mesh& mesh, const Vec3& low, const Vec3& high, double hole_m) {
  constexpr double kWall_m = 0.1;
  const Vec3 wall = Vec3::Constant(kWall_m);
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool is_high : {false, true}) {
      Vec3 from = low - wall;
      Vec3 to = high + wall;
      (is_high ? from[axis] : to[axis]) = is_high ? high[axis] : low[axis];
      if (axis == 0 && is_high && hole_m > 0.0) continue;
      testing::add_cuboid(mesh, from, to);
    }
  }
  if (!(hole_m > 0.0)) return;
  const Vec3 middle = 0.5 * (low + high);
  const double x0_m = high.x();
  const double x1_m = x0_m + kWall_m;
  const double y0_m = middle.y() - hole_m;
  const double y1_m = middle.y() + hole_m;
  testing::add_cuboid(mesh, {x0_m, low.y(), low.z()}, {x1_m, y0_m, high.z()});
  testing::add_cuboid(mesh, {x0_m, y1_m, low.z()}, {x1_m, high.y(), high.z()});
  testing::add_cuboid(mesh, {x0_m, y0_m, low.z()}, {x1_m, y1_m, middle.z() - hole_m});
  testing::add_cuboid(mesh, {x0_m, y0_m, middle.z() + hole_m}, {x1_m, y1_m, high.z()});
}

// The end whose place was searched to the end may have more of it than the other has found so far.
TEST(CellWay, APocketIsCompleteOnlyIfItWasSearched) {
  scene::Mesh mesh;
  add_room(mesh, {0, 0, 0}, {3, 3, 3}, 0.06);
  add_room(mesh, {10, 0, 0}, {16, 6, 6}, 0.0);
  testing::Random random(7);
  for (int i = 0; i < 60; ++i) {
    const Vec3 corner(random.uniform(0.3, 2.6), random.uniform(0.3, 2.6), random.uniform(0.3, 2.6));
    if (std::abs(corner.y() - 1.5) < 0.2 && std::abs(corner.z() - 1.5) < 0.2) continue;
    testing::add_cuboid(mesh, corner, corner + Vec3(0.05, 0.2, 0.1));
  }
  const SearchScene scene(mesh);
  const CellOptions options{0.02, 0.01, 2'000'000, /*comfort_m=*/0.1};
  const Vec3 cluttered_W(0.15, 0.15, 0.15);
  const Vec3 closed_W(13, 3, 3);
  for (const bool is_at_end : {false, true}) {
    const CellResult result =
        is_at_end ? cell_way(scene.space(), cluttered_W, closed_W, options, Deadline::never())
                  : cell_way(scene.space(), closed_W, cluttered_W, options, Deadline::never());
    ASSERT_TRUE(result.exhausted);
    ASSERT_TRUE(result.pocket && result.pocket->is_complete);
    EXPECT_EQ(result.pocket->is_at_end, is_at_end) << "a hole leads out of the other room";
    EXPECT_TRUE(result.pocket->reached_W.contains(closed_W));
  }
}

/// A cavity of 3.2 x 2.4 x 0.2 m between two sheets of boards, whose joints of 3 cm are narrower
/// than the ball, and a room of 3 m in front of it.
SearchScene cavity_beside_a_room() {
  scene::Mesh mesh;
  for (const double z_m : {0.0, 0.21}) {
    for (int board = 0; board < 16; ++board) {
      const double x_m = -1.6 + 0.2 * board;
      testing::add_cuboid(mesh, {x_m, -1.2, z_m}, {x_m + 0.17, 1.2, z_m + 0.01});
    }
  }
  testing::add_cuboid(mesh, {-1.7, -1.3, -3.0}, {-1.6, 1.3, 0.22});
  testing::add_cuboid(mesh, {1.57, -1.3, -3.0}, {1.67, 1.3, 0.22});
  testing::add_cuboid(mesh, {-1.7, -1.3, -3.0}, {1.67, -1.2, 0.22});
  testing::add_cuboid(mesh, {-1.7, 1.2, -3.0}, {1.67, 1.3, 0.22});
  testing::add_cuboid(mesh, {-1.7, -1.3, -3.1}, {1.67, 1.3, -3.0});
  return SearchScene(mesh);
}

// From whichever end. A larger camera would find the cavity narrow, a smaller one would not.
TEST(CellWay, EndsSoonerWhereAnEndIsInANarrowPlace) {
  const SearchScene scene = cavity_beside_a_room();
  const Vec3 cavity_W(0.13, 0.2, 0.1);
  const Vec3 room_W(-0.2, 0.1, -1.5);
  CellOptions options = options_of(0.02 * kBall_m, 80'000);
  options.max_cells_if_narrow = 30'000;
  for (const bool is_at_end : {false, true}) {
    for (const double narrow_m : {0.0, 0.05, 0.3}) {
      SCOPED_TRACE(narrow_m);
      options.narrow_m = narrow_m;
      const CellResult result = cell_way(scene.space(), is_at_end ? room_W : cavity_W,
                                         is_at_end ? cavity_W : room_W, options, Deadline::never());
      EXPECT_TRUE(result.way_W.empty());
      EXPECT_FALSE(result.exhausted);
      const bool is_narrow = narrow_m > 0.1;
      EXPECT_EQ(result.cells < 31'000, is_narrow) << result.cells;
      ASSERT_TRUE(result.pocket);
      EXPECT_EQ(result.pocket->is_at_end, is_at_end);
      EXPECT_EQ(result.pocket->is_narrow, is_narrow);
      EXPECT_FALSE(result.pocket->is_complete);
      EXPECT_TRUE(result.pocket->reached_W.contains(cavity_W));
      EXPECT_FALSE(result.pocket->reached_W.contains(room_W));
    }
  }
}

// Neither half of a room is narrow, or much smaller than the other.
TEST(CellWay, BlamesNoEndOfTwoAlike) {
  CellOptions options = options_of(0.02 * kBall_m, 30'000);
  options.narrow_m = 0.2;
  const CellResult result = RoomCase({{0.1, 0.2, 0.9 * kBall_m}}).way(options);
  EXPECT_TRUE(result.way_W.empty());
  EXPECT_FALSE(result.pocket);
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
              kBall_m * (1.0 - kCellRounding));
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
