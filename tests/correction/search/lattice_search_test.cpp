// SPDX-License-Identifier: MIT
#include "daemon/correction/search/lattice_search.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file
using base::Deadline;
using Cell = std::array<int, 3>;

// A part of the ball's radius that is larger than the rounding of distances of a few metres.
constexpr double kLatticeRounding = 1e-9;

double length_m(const std::vector<Vec3>& way_W) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < way_W.size(); ++i) sum_m += (way_W[i] - way_W[i - 1]).norm();
  return sum_m;
}

double least_gap_m(const SearchScene& scene, const Vec3& a, const Vec3& b, double radius_m) {
  const int steps = 2 + static_cast<int>((b - a).norm() / (0.02 * radius_m));
  double least_m = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= steps; ++k)
    least_m = std::min(least_m, scene.distance_m(a + (b - a) * (double(k) / steps)) - radius_m);
  return least_m;
}

void expect_way(const SearchScene& scene, const LatticeResult& result, const Vec3& from_W,
                const Vec3& to_W, double radius_m) {
  ASSERT_GE(result.way_W.size(), 2U);
  EXPECT_EQ(result.way_W.front(), from_W);
  EXPECT_EQ(result.way_W.back(), to_W);
  for (std::size_t i = 1; i < result.way_W.size(); ++i) {
    EXPECT_GT(scene.distance_m(result.way_W[i]), radius_m);
    EXPECT_GE(least_gap_m(scene, result.way_W[i - 1], result.way_W[i], radius_m),
              -kLatticeRounding * radius_m);
  }
}

/// The least cost over the points with every coordinate up to `reach`, by Dijkstra's algorithm,
/// with steps on which the ball is nowhere nearer than `allowed_m`.
class Oracle {
 public:
  Oracle(const SearchScene& scene, const Vec3& from_W, const Vec3& to_W,
         const LatticeOptions& options, double allowed_m)
      : scene_(scene),
        space_(scene.space()),
        from_W_(from_W),
        to_W_(to_W),
        options_(options),
        allowed_m_(allowed_m) {}

  double cost_m(int reach) {
    std::map<Cell, double> cost;
    std::set<std::pair<double, Cell>> open = {{0.0, Cell{}}};
    cost[Cell{}] = 0.0;
    double best_m = std::numeric_limits<double>::infinity();
    while (!open.empty()) {
      const auto [sum_m, at] = *open.begin();
      open.erase(open.begin());
      const double rest_m = (place_W(at) - to_W_).norm();
      if (rest_m <= 1.8 * options_.spacing_m && is_free(place_W(at), to_W_))
        best_m = std::min(best_m, sum_m + rest_m);
      for (int code = 0; code < 27; ++code) {
        const Cell next = {at[0] + code % 3 - 1, at[1] + code / 3 % 3 - 1, at[2] + code / 9 - 1};
        if (next == at || std::ranges::any_of(next, [&](int c) { return std::abs(c) > reach; }))
          continue;
        if (!(gap_m(next) > 0.0) || !is_free(place_W(at), place_W(next))) continue;
        const double comfort_m = 0.5 * options_.ball_radius_m;
        const double near =
            std::clamp(1.0 - std::min(gap_m(at), gap_m(next)) / comfort_m, 0.0, 1.0);
        const double total_m = sum_m + (place_W(next) - place_W(at)).norm() * (1.0 + near);
        const auto known = cost.find(next);
        if (known != cost.end() && known->second <= total_m) continue;
        if (known != cost.end()) open.erase({known->second, next});
        cost[next] = total_m;
        open.insert({total_m, next});
      }
    }
    return best_m;
  }

  double cost_of(const std::vector<Vec3>& way_W) {
    double sum_m = 0.0;
    for (std::size_t i = 1; i + 1 < way_W.size(); ++i) {
      const double comfort_m = 0.5 * options_.ball_radius_m;
      const double gap_m = std::min(gap_at_m(way_W[i - 1]), gap_at_m(way_W[i]));
      sum_m +=
          (way_W[i] - way_W[i - 1]).norm() * (1.0 + std::clamp(1.0 - gap_m / comfort_m, 0.0, 1.0));
    }
    return sum_m + (way_W.back() - way_W[way_W.size() - 2]).norm();
  }

 private:
  [[nodiscard]] Vec3 place_W(const Cell& cell) const {
    return from_W_ + options_.spacing_m * Vec3(cell[0], cell[1], cell[2]);
  }
  // As the search is told it: free_space_test has the oracle of that.
  [[nodiscard]] double gap_at_m(const Vec3& point_W) const {
    const double horizon_m = std::max(0.9 * options_.spacing_m, 0.5 * options_.ball_radius_m);
    return space_.ball_gap_m(point_W, options_.ball_radius_m, horizon_m);
  }
  double gap_m(const Cell& cell) {
    const auto [entry, is_new] = gaps_m_.try_emplace(cell, 0.0);
    if (is_new) entry->second = gap_at_m(place_W(cell));
    return entry->second;
  }
  // A gap changes by no more than the ball moves. What is as near as can be told is not allowed
  // where touching is not, and is where a little more is.
  [[nodiscard]] bool is_free(const Vec3& a, const Vec3& b) const {
    const Vec3 middle = 0.5 * (a + b);
    const double half_m = 0.5 * (b - a).norm();
    const double gap_m = scene_.distance_m(middle) - options_.ball_radius_m - allowed_m_;
    if (gap_m > half_m) return true;
    if (gap_m <= 0.0) return false;
    if (half_m < 1e-4) return allowed_m_ < 0.0;
    return is_free(a, middle) && is_free(middle, b);
  }

  const SearchScene& scene_;
  FreeSpace space_;
  const Vec3 from_W_;
  const Vec3 to_W_;
  const LatticeOptions options_;
  const double allowed_m_;
  std::map<Cell, double> gaps_m_;
};

TEST(LatticeWay, StraightThroughTheOpen) {
  const SearchScene scene({});
  const LatticeResult result =
      lattice_way(scene.space(), {0, 0, 0}, {3, 0.1, 0}, {0.2, 0.25, 1000}, Deadline::never());
  expect_way(scene, result, {0, 0, 0}, {3, 0.1, 0}, 0.2);
  EXPECT_LT(length_m(result.way_W), 3.2);
}

TEST(LatticeWay, GoesRoundBallsToAvoid) {
  const SearchScene scene({});
  const std::array<AvoidedBall, 2> balls = {{{{1, 0, 0}, 0.5}, {{2, 0.4, 0}, 0.4}}};
  LatticeOptions options{0.2, 0.1, 40000};
  options.avoided = balls;
  const LatticeResult result =
      lattice_way(scene.space(), {0, 0, 0}, {3, 0.1, 0}, options, Deadline::never());
  expect_way(scene, result, {0, 0, 0}, {3, 0.1, 0}, 0.2);
  for (const Vec3& place_W : result.way_W) {
    for (const AvoidedBall& ball : balls) {
      EXPECT_GE((place_W - ball.center_W).norm(), ball.radius_m);
    }
  }
}

TEST(LatticeWay, EndsAtItsLargestCost) {
  const SearchScene scene(wall_with_gap(0.8, 2.0));
  const auto search = [&](double max_cost_m) {
    LatticeOptions options{0.1, 0.2, 20000};
    options.max_cost_m = max_cost_m;
    return lattice_way(scene.space(), {0, 0, 1.5}, {0, 0, -1.5}, options, Deadline::never());
  };
  const LatticeResult whole = search(std::numeric_limits<double>::infinity());
  ASSERT_FALSE(whole.way_W.empty());
  EXPECT_GE(whole.cost_m, length_m(whole.way_W) - 0.4) << "but for the last step";
  const LatticeResult none = search(0.8 * whole.cost_m);
  EXPECT_TRUE(none.way_W.empty());
  EXPECT_FALSE(none.exhausted);
  EXPECT_LT(none.points, whole.points);
  EXPECT_EQ(search(1.3 * whole.cost_m).way_W, whole.way_W);
}

TEST(LatticeWay, IsFreeForTheBall) {
  testing::Random random(1);
  const Vec3 from_W(-2.0, 0.03, 0.02);
  const Vec3 to_W(2.0, -0.05, 0.04);
  int found = 0;
  for (int run = 0; run < 12; ++run) {
    const SearchScene scene(scattered_cuboids(random, 14, 0.6));
    const LatticeOptions options{0.12, 0.1 + 0.02 * run, 20000};
    const LatticeResult result =
        lattice_way(scene.space(), from_W, to_W, options, Deadline::never());
    if (result.way_W.empty()) continue;
    ++found;
    expect_way(scene, result, from_W, to_W, options.ball_radius_m);
  }
  EXPECT_GE(found, 8);
}

// Between the best of what is surely free, times the weight of what is left, and the best of what
// may pass for it.
TEST(LatticeWay, IsNearlyTheBestThatDijkstraFinds) {
  const Vec3 from_W(-0.9, 0.03, 0.02);
  const Vec3 to_W(0.9, -0.05, 0.04);
  int compared = 0;
  for (int run = 0; run < 4; ++run) {
    scene::Mesh mesh;
    testing::add_cuboid(mesh, {-0.1, -0.3 - 0.05 * run, -0.4}, {0.1, 0.2, 0.3 + 0.05 * run});
    const SearchScene scene(std::move(mesh));
    const LatticeOptions options{0.1, 0.3, 20000};
    const LatticeResult result =
        lattice_way(scene.space(), from_W, to_W, options, Deadline::never());
    expect_way(scene, result, from_W, to_W, options.ball_radius_m);
    Oracle strict(scene, from_W, to_W, options, 0.0);
    Oracle loose(scene, from_W, to_W, options, -kLatticeRounding * options.ball_radius_m);
    const double cost_m = strict.cost_of(result.way_W);
    EXPECT_LE(cost_m, kLatticeGreed * strict.cost_m(5) + 1e-9);
    EXPECT_GE(cost_m, loose.cost_m(5) - 1e-9);
    ++compared;
  }
  EXPECT_EQ(compared, 4);
}

TEST(LatticeWay, KeepsItsDistanceWhereThatCostsLittle) {
  // A wide gap with its middle off the straight line, and no need to touch its side.
  const SearchScene scene(wall_with_gap(-0.15, 3.0));
  const Vec3 from_W(0, 0, 1.5);
  const Vec3 to_W(0, 0, -1.5);
  const LatticeResult result =
      lattice_way(scene.space(), from_W, to_W, {0.1, 0.2, 20000}, Deadline::never());
  expect_way(scene, result, from_W, to_W, 0.1);
  double least_m = 1.0;
  for (std::size_t i = 1; i < result.way_W.size(); ++i) {
    least_m = std::min(least_m, least_gap_m(scene, result.way_W[i - 1], result.way_W[i], 0.1));
  }
  EXPECT_GE(least_m, 0.04);
}

/// About the origin, 2 m wide, of plates of that thickness.
scene::Mesh closed_room(double thick_m) {
  const double outer_m = 1.0 + thick_m;
  scene::Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 min = Vec3::Constant(-outer_m);
      Vec3 max = Vec3::Constant(outer_m);
      (side < 0.0 ? max : min)[axis] = side;
      testing::add_cuboid(mesh, min, max);
    }
  }
  return mesh;
}

// However thin the wall is beside the steps, and however small the ball.
TEST(LatticeWay, NoneWhereAWallCloses) {
  for (const double thick_m : {0.0, 0.1, 0.3}) {
    const SearchScene scene(closed_room(thick_m));
    for (const double radius_m : {0.1, 0.01}) {
      for (const double spacing_m : {0.1, 0.35, 0.45, 0.55, 0.8}) {
        const LatticeResult result = lattice_way(scene.space(), {0.02, 0.07, 0}, {3, 0, 0},
                                                 {radius_m, spacing_m, 20000}, Deadline::never());
        EXPECT_TRUE(result.way_W.empty());
        EXPECT_TRUE(result.exhausted) << thick_m << " " << radius_m << " " << spacing_m;
      }
    }
  }
}

// A gap wider than the ball is found, one that is narrower is not.
TEST(LatticeWay, TellsGapsByTheirWidth) {
  for (const double width_m : {0.3, 0.5}) {
    const SearchScene scene(wall_with_gap(0.8, 0.8 + width_m));
    const LatticeResult result = lattice_way(scene.space(), {0.05, 0, 1}, {0.05, 0, -1},
                                             {0.2, 0.1, 20000}, Deadline::never());
    EXPECT_EQ(!result.way_W.empty(), width_m > 0.4);
    // The wall is 30 m high, and nobody went round it.
    EXPECT_FALSE(result.exhausted);
  }
}

// Both sides of the pillar are as short, and each run is told to keep to one of them.
TEST(LatticeWay, KeepsToAWayWhereThatCostsLittle) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-0.2, -0.2, -3.0}, {0.2, 0.2, 3.0});
  const SearchScene scene(std::move(mesh));
  const LatticeOptions options{0.1, 0.15, 20000};
  const Vec3 from_W(-1.5, 0, 0);
  const Vec3 to_W(1.5, 0, 0);
  const double shortest_m =
      length_m(lattice_way(scene.space(), from_W, to_W, options, Deadline::never()).way_W);
  for (const double side : {-1.0, 1.0}) {
    const std::vector<Vec3> about_W = {from_W, {0, 0.1 * side, 0}, to_W};
    LatticeOptions kept = options;
    kept.about_W = about_W;
    const LatticeResult result = lattice_way(scene.space(), from_W, to_W, kept, Deadline::never());
    expect_way(scene, result, from_W, to_W, options.ball_radius_m);
    EXPECT_LT(length_m(result.way_W), 1.15 * shortest_m);
    for (const Vec3& point : result.way_W) {
      const bool is_beside_it = std::abs(point.x()) < 0.2;
      EXPECT_TRUE(!is_beside_it || side * point.y() > 0.0) << side;
    }
  }
}

// Being far makes a step cost at most 15 % more, so a way that is much shorter is taken.
TEST(LatticeWay, DoesNotGoFarForKeepingToAWay) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-0.2, -0.2, -3.0}, {0.2, 4.0, 3.0});
  const SearchScene scene(std::move(mesh));
  const std::vector<Vec3> about_W = {{-1.5, 0, 0}, {0, 0.1, 0}, {1.5, 0, 0}};
  LatticeOptions options{0.1, 0.15, 20000};
  options.about_W = about_W;
  const LatticeResult result =
      lattice_way(scene.space(), about_W.front(), about_W.back(), options, Deadline::never());
  expect_way(scene, result, about_W.front(), about_W.back(), options.ball_radius_m);
  EXPECT_LT(length_m(result.way_W), 3.6);
}

TEST(LatticeWay, StopsAtItsBound) {
  const SearchScene scene(wall_with_gap(0.8, 1.3));
  const LatticeOptions enough{0.2, 0.1, 20000};
  LatticeOptions few = enough;
  few.max_points = 200;
  EXPECT_FALSE(lattice_way(scene.space(), {0.05, 0, 1}, {0.05, 0, -1}, enough, Deadline::never())
                   .way_W.empty());
  const LatticeResult result =
      lattice_way(scene.space(), {0.05, 0, 1}, {0.05, 0, -1}, few, Deadline::never());
  EXPECT_TRUE(result.way_W.empty());
  EXPECT_FALSE(result.exhausted);
}

TEST(LatticeWay, StopsAtTheDeadline) {
  const SearchScene scene(wall_with_gap(20.8, 21.3));
  const LatticeResult result = lattice_way(scene.space(), {0.05, 0, 1}, {0.05, 0, -1},
                                           {0.2, 0.1, 1'000'000}, Deadline::after_s(0.0));
  EXPECT_TRUE(result.way_W.empty());
  EXPECT_FALSE(result.exhausted);
}

TEST(LatticeWay, IsTheSameEachTime) {
  testing::Random random(3);
  const SearchScene scene(scattered_cuboids(random, 14, 0.6));
  const LatticeOptions options{0.1, 0.15, 20000};
  const LatticeResult a =
      lattice_way(scene.space(), {-2, 0, 0}, {2, 0, 0}, options, Deadline::never());
  const LatticeResult b =
      lattice_way(scene.space(), {-2, 0, 0}, {2, 0, 0}, options, Deadline::never());
  ASSERT_FALSE(a.way_W.empty());
  EXPECT_EQ(a.way_W, b.way_W);
}

}  // namespace
}  // namespace camway::correction
