// SPDX-License-Identifier: MIT
#include "tools/drawing/storeys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/random.h"
#include "tests/tools/drawing/drawn_house.h"

namespace camway::draw {
namespace {

using geometry::Vec3;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pointwise;
using testing::Random;

constexpr double kLength_m = 14.0;
constexpr double kWidth_m = 9.0;
constexpr double kSlab_m = 0.25;

/// A building with furniture on all its floors, and a flat roof.
struct Building {
  scene::Mesh mesh;
  std::vector<double> floors_m;
};

Building random_building(Random& random, int storeys) {
  Building building;
  double floor_m = random.uniform(-20.0, 20.0);
  for (int i = 0; i <= storeys; ++i) {
    add_box(building.mesh, {0, floor_m - kSlab_m, 0}, {kLength_m, floor_m, kWidth_m});
    if (i == storeys) break;  // the roof
    building.floors_m.push_back(floor_m);
    const double next_m = floor_m + random.uniform(2.4, 4.0);
    const double ceiling_m = next_m - kSlab_m;
    for (const double z : {0.0, kWidth_m - 0.2}) {
      add_box(building.mesh, {0, floor_m, z}, {kLength_m, ceiling_m, z + 0.2});
    }
    for (const double x : {0.0, 0.5 * kLength_m, kLength_m - 0.2}) {
      add_box(building.mesh, {x, floor_m, 0}, {x + 0.2, ceiling_m, 0.6 * kWidth_m});
    }
    for (int table = random.integer(0, 6); table > 0; --table) {
      const Vec3 low(random.uniform(0, kLength_m - 2), floor_m, random.uniform(0, kWidth_m - 1));
      add_box(building.mesh, low,
              low + Vec3(random.uniform(0.5, 2), random.uniform(0.4, 1.1), random.uniform(0.5, 1)));
    }
    floor_m = next_m;
  }
  return building;
}

/// Adds a walk from wall to wall on a floor, at the height of eyes, of a robot or of a lamp.
void add_walk(Random& random, double floor_m, std::vector<Vec3>& points_W) {
  const double eyes_m = random.uniform(0.2, 2.0);
  Vec3 at(random.uniform(1, kLength_m - 1), 0, random.uniform(1, kWidth_m - 1));
  const Vec3 to(random.uniform(1, kLength_m - 1), 0, random.uniform(1, kWidth_m - 1));
  for (int i = 0; i <= 40; ++i) {
    const Vec3 p = at + i / 40.0 * (to - at);
    points_W.emplace_back(p.x(), floor_m + eyes_m, p.z());
  }
}

/// A path is on the floors that it was made on, whatever stands there.
TEST(VisitedStoreys, AreThoseOfTheWalk) {
  Random random(kDrawSeed);
  for (int trial = 0; trial < 40; ++trial) {
    const Building building = random_building(random, random.integer(1, 5));
    std::vector<double> visited_m;
    std::vector<Vec3> points_W;
    std::vector<double> floor_of;
    for (const double floor_m : building.floors_m) {
      if (random.chance(0.4) && !(visited_m.empty() && floor_m == building.floors_m.back())) {
        continue;
      }
      visited_m.push_back(floor_m);
      add_walk(random, floor_m, points_W);
      floor_of.resize(points_W.size(), floor_m);
    }
    const bool is_z = random.chance(0.5);
    if (is_z) {
      for (Vec3& p_W : points_W) p_W = turned_to_z_up(p_W);
    }
    const VisitedStoreys found =
        visited_storeys(is_z ? turned_to_z_up(building.mesh) : building.mesh,
                        is_z ? SceneUp::kZ : SceneUp::kY, points_W, 0);
    ASSERT_THAT(found.floors_m, Pointwise(DoubleNear(1e-9), visited_m)) << trial;
    ASSERT_EQ(found.of_point.size(), points_W.size());
    for (std::size_t i = 0; i < points_W.size(); ++i) {
      EXPECT_NEAR(found.floors_m[found.of_point[i]], floor_of[i], 1e-9) << trial << ", " << i;
    }
  }
}

/// Stairs without landings: the storey changes once, between the two floors.
TEST(VisitedStoreys, StairsLeadFromOneToTheNext) {
  scene::Mesh mesh;
  add_box(mesh, {0, -0.2, 0}, {20, 0, 4});
  add_box(mesh, {10, 2.8, 0}, {20, 3, 4});
  for (int i = 0; i < 15; ++i) {
    add_box(mesh, {5 + i / 3.0, 0, 1.5}, {5 + (i + 1) / 3.0, 0.2 * (i + 1), 2.5});
  }
  std::vector<Vec3> points_W;
  for (double x = 1.0; x < 19.0; x += 0.1) {
    points_W.emplace_back(x, 1.6 + 3.0 * std::clamp((x - 5.0) / 5.0, 0.0, 1.0), 2.0);
  }
  const VisitedStoreys found = visited_storeys(mesh, SceneUp::kY, points_W, 0);
  EXPECT_THAT(found.floors_m, ElementsAre(DoubleNear(0, 1e-9), DoubleNear(3, 1e-9)));
  EXPECT_TRUE(std::ranges::is_sorted(found.of_point));
  EXPECT_EQ(found.of_point.front(), 0U);
  EXPECT_EQ(found.of_point.back(), 1U);
}

/// A shot about a table is on the floor that the table stands on.
TEST(VisitedStoreys, ATableIsNoStorey) {
  scene::Mesh mesh = small_house();
  std::vector<Vec3> points_W;
  for (int i = 0; i < 60; ++i) {
    points_W.emplace_back(4.5 + std::cos(0.1 * i), 2.6, 1.5 + std::sin(0.1 * i));
  }
  EXPECT_THAT(visited_storeys(mesh, SceneUp::kY, points_W, 0).floors_m, ElementsAre(0.0));
}

/// A building of two storeys, and stairs of two flights with a half landing between them.
struct StairsBuilding {
  scene::Mesh mesh;
  double floor_m;
  double storey_m;
  std::vector<Vec3> walk_W;  ///< up the stairs, at the height of eyes
};

/// Adds the treads of a flight along z.
void add_flight(scene::Mesh& mesh, double x, const Vec3& begin, const Vec3& end, int treads) {
  for (int i = 0; i < treads; ++i) {
    const Vec3 low = begin + static_cast<double>(i) / treads * (end - begin);
    const Vec3 high = begin + (i + 1.0) / treads * (end - begin);
    add_box(mesh, {x, high.y() - 0.2, std::min(low.z(), high.z())},
            {x + 1.4, high.y(), std::max(low.z(), high.z())});
  }
}

StairsBuilding random_stairs(Random& random) {
  StairsBuilding building{{}, random.uniform(-10, 10), random.uniform(2.6, 5.0), {}};
  scene::Mesh& mesh = building.mesh;
  const double low_m = building.floor_m;
  const double half_m = low_m + building.storey_m / 2;
  const double high_m = low_m + building.storey_m;
  const double foot_z = 2.0 + 2.0 * building.storey_m / 2;  // the flights rise by 1 : 2
  add_box(mesh, {-10, low_m - 0.3, 0}, {13, low_m, foot_z + 8});
  for (const auto& [low_x, high_x, low_z] :
       {std::array{-10.0, 0.0, 0.0}, {3.0, 13.0, 0.0}, {0.0, 3.0, foot_z}}) {
    add_box(mesh, {low_x, high_m - 0.3, low_z}, {high_x, high_m, foot_z + 8});
  }
  const double landing_z = random.uniform(1.2, 2.0);
  const int treads = random.integer(7, 14);
  add_box(mesh, {0, half_m - 0.2, 2.0 - landing_z}, {3, half_m, 2.0});
  add_flight(mesh, 0.0, {0, low_m, foot_z}, {0, half_m, 2}, treads);
  add_flight(mesh, 1.6, {0, half_m, 2}, {0, high_m, foot_z}, treads);
  const std::vector<Vec3> way{{0.7, low_m, foot_z + random.uniform(1, 6)},
                              {0.7, low_m, foot_z},
                              {0.7, half_m, 2},
                              {0.7, half_m, 1.2},
                              {2.3, half_m, 1.2},
                              {2.3, half_m, 2},
                              {2.3, high_m, foot_z},
                              {2.3, high_m, foot_z + random.uniform(1, 6)}};
  const double eyes_m = random.uniform(1.4, 1.9);
  for (std::size_t leg = 0; leg + 1 < way.size(); ++leg) {
    const int steps = random.integer(5, 40);  // at a speed of its own
    for (int i = 0; i < steps; ++i) {
      const Vec3 p = way[leg] + static_cast<double>(i) / steps * (way[leg + 1] - way[leg]);
      building.walk_W.emplace_back(p.x(), p.y() + eyes_m, p.z());
    }
  }
  return building;
}

/// However long the camera stays on a half landing, the storeys are the two floors, and the path
/// changes between them once.
TEST(VisitedStoreys, ALandingIsNoStorey) {
  Random random(kDrawSeed);
  for (int trial = 0; trial < 100; ++trial) {
    const StairsBuilding building = random_stairs(random);
    const VisitedStoreys found = visited_storeys(building.mesh, SceneUp::kY, building.walk_W, 0);
    ASSERT_THAT(found.floors_m, ElementsAre(DoubleNear(building.floor_m, 1e-9),
                                            DoubleNear(building.floor_m + building.storey_m, 1e-9)))
        << trial;
    EXPECT_TRUE(std::ranges::is_sorted(found.of_point)) << trial;
    EXPECT_EQ(found.of_point.front(), 0U) << trial;
    EXPECT_EQ(found.of_point.back(), 1U) << trial;
  }
}

/// A short stay on a storey counts, without a keyframe there.
TEST(VisitedStoreys, AShortStayCounts) {
  const scene::Mesh house = small_house();
  std::vector<Vec3> points_W(300, Vec3(2, 1.6, 2));
  std::fill_n(points_W.begin() + 150, 3, Vec3(2, 4.6, 2));
  EXPECT_THAT(visited_storeys(house, SceneUp::kY, points_W, 0).floors_m, ElementsAre(0.0, 3.0));
}

TEST(VisitedStoreys, AGlimpseOfAStoreyCountsWhereAKeyframeIs) {
  const scene::Mesh house = small_house();
  std::vector<Vec3> points_W{{2, 4.6, 2}};
  points_W.resize(100, Vec3(2, 1.6, 2));
  EXPECT_EQ(visited_storeys(house, SceneUp::kY, points_W, 0).floors_m.size(), 1U);
  EXPECT_EQ(visited_storeys(house, SceneUp::kY, points_W, 1).floors_m.size(), 2U);
}

/// Returns a hill of `height_m` over 60 m.
scene::Mesh hill(double height_m) {
  constexpr std::uint32_t kSteps = 30;
  scene::Mesh mesh;
  for (std::uint32_t i = 0; i <= kSteps; ++i) {
    for (std::uint32_t j = 0; j <= kSteps; ++j) {
      const double x = 2.0 * i;
      const double z = 2.0 * j;
      const double share =
          std::sin(x / 60 * std::numbers::pi) * std::sin(z / 60 * std::numbers::pi);
      mesh.vertices.emplace_back(x, height_m * share, z);
      if (i == kSteps || j == kSteps) continue;
      const std::uint32_t at = i * (kSteps + 1) + j;
      mesh.triangles.push_back({at, at + 1, at + kSteps + 1});
      mesh.triangles.push_back({at + 1, at + kSteps + 2, at + kSteps + 1});
    }
  }
  return mesh;
}

TEST(VisitedStoreys, AHillHasNone) {
  std::vector<Vec3> points_W;
  for (double x = 3; x < 57; x += 0.5) {
    points_W.emplace_back(x, 2.0 + 18.0 * std::sin(x / 60 * std::numbers::pi), 30.0);
  }
  EXPECT_THAT(visited_storeys(hill(18.0), SceneUp::kY, points_W, 0).floors_m, IsEmpty());
  EXPECT_THAT(visited_storeys({}, SceneUp::kY, points_W, 0).floors_m, IsEmpty());
  EXPECT_THAT(visited_storeys(hill(18.0), SceneUp::kY, {}, 0).of_point, IsEmpty());
  EXPECT_THAT(storeys_of(hill(18.0), SceneUp::kY), IsEmpty());
  EXPECT_EQ(up_of(hill(18.0)), SceneUp::kY);
}

/// All floors of a building are found, and its roof is none.
TEST(StoreysOfScene, AreItsFloors) {
  Random random(kDrawSeed);
  for (int trial = 0; trial < 150; ++trial) {
    const Building building = random_building(random, random.integer(1, 5));
    EXPECT_THAT(storeys_of(building.mesh, SceneUp::kY),
                Pointwise(DoubleNear(1e-9), building.floors_m));
    const scene::Mesh turned = turned_to_z_up(building.mesh);
    EXPECT_THAT(storeys_of(turned, SceneUp::kZ), Pointwise(DoubleNear(1e-9), building.floors_m));
    EXPECT_EQ(up_of(building.mesh), SceneUp::kY);
    EXPECT_EQ(up_of(turned), SceneUp::kZ);
  }
  EXPECT_THAT(storeys_of({}, SceneUp::kY), IsEmpty());
}

}  // namespace
}  // namespace camway::draw
