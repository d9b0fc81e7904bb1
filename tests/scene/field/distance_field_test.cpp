// SPDX-License-Identifier: MIT
#include "daemon/scene/field/distance_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "daemon/scene/field/surface_cells.h"
#include "tests/scene/test_meshes.h"
#include "tests/scene/voxels/voxel_oracle.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;
using ::testing::HasSubstr;

constexpr double kBeyond_m = std::numeric_limits<double>::infinity();

oracle::Real true_distance_m(const Mesh& mesh, const Vec3& point) {
  oracle::Real least = HUGE_VALL;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    least = std::min(least, oracle::distance_m(point, mesh.triangle(i)));
  }
  return least;
}

double uniform(testing::Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Returns a point in the bounds of the mesh, extended by a quarter of their size on each side.
Vec3 point_about(testing::Random& random, const Box& bounds) {
  Vec3 point;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    point[axis] = uniform(random, -0.25, 1.25);
  }
  return bounds.min() + point.cwiseProduct(bounds.sizes());
}

/// Moves some coordinates of `point` to a face between cells, or an ulp to either side of it.
Vec3 snapped_to_faces(testing::Random& random, const CellGrid& grid, Vec3 point) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (random() % 2 == 0) continue;
    const double face = std::round(grid.in_cells(point)[axis]);
    point[axis] = grid.low_W[axis] + face * grid.resolution_m;
    if (random() % 3 == 0) point[axis] = std::nextafter(point[axis], kBeyond_m);
    if (random() % 3 == 0) point[axis] = std::nextafter(point[axis], -kBeyond_m);
  }
  return point;
}

/// Returns by how much the bound is below the distance, on average and in cells. Fails if it is
/// above.
double checked_mean_loss(testing::Random& random, const Mesh& mesh, const DistanceField& field,
                         int points) {
  const Box bounds = mesh.bounds();
  const double resolution_m = field.statistics().resolution_m;
  const auto grid = CellGrid::around(bounds, resolution_m);
  double loss_m = 0.0;
  for (int i = 0; i < points; ++i) {
    Vec3 point = point_about(random, bounds);
    if (i % 4 == 1) point = snapped_to_faces(random, *grid, point);
    if (i % 4 == 2) point = mesh.vertices[random() % mesh.vertices.size()];
    if (i % 8 == 3) point += 3.0 * resolution_m * random.direction();
    const oracle::Real distance_m = true_distance_m(mesh, point);
    const double bound_m = field.clearance_at_least_m(point);
    EXPECT_GE(bound_m, 0.0);
    EXPECT_LE(static_cast<oracle::Real>(bound_m), distance_m) << point.transpose();
    loss_m += static_cast<double>(distance_m) - bound_m;
  }
  return loss_m / points / resolution_m;
}

void expect_never_more(testing::Random& random, const Mesh& mesh, int points) {
  const auto result = DistanceField::build(mesh);
  ASSERT_TRUE(result) << result.error;
  EXPECT_EQ(result.error, "");
  checked_mean_loss(random, mesh, **result, points);
}

/// Returns triangles of sizes from a thousandth of the scene to the whole scene.
Mesh soup(testing::Random& random, int triangles, double size_m, const Vec3& middle) {
  std::vector<Triangle> result;
  for (int i = 0; i < triangles; ++i) {
    const double edge_m = size_m * random.log_uniform(1e-3, 0.5);
    const Vec3 at = middle + size_m * (0.5 * random.direction());
    Triangle t{at, at, at};
    for (Vec3& vertex : t) vertex += edge_m * random.direction();
    if (i % 10 == 0) t[2] = t[1];
    if (i % 10 == 1) t[2] = t[1] + 1e-9 * edge_m * random.direction();
    result.push_back(t);
  }
  return mesh_of_triangles(result);
}

/// Returns the four walls of a room of 4 x 3 x 2, of this thickness (0: two walls at one place).
Mesh room(double scale, double thickness_m, const Vec3& corner) {
  Mesh mesh;
  const Vec3 size(4.0 * scale, 3.0 * scale, 2.0 * scale);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, 1.0}) {
      if (axis == 1 && side > 0.5) continue;
      Vec3 min = corner;
      min[axis] += side * (size[axis] - thickness_m);
      Vec3 max = corner + size;
      max[axis] = min[axis] + thickness_m;
      testing::add_cuboid(mesh, min, max);
    }
  }
  mesh.objects.push_back({"room", 0, static_cast<std::uint32_t>(mesh.triangles.size())});
  return mesh;
}

TEST(DistanceField, IsNeverMoreThanTheDistanceInSoups) {
  testing::Random random(1);
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const double size_m = random.log_uniform(1e-3, 1e3);
    expect_never_more(random, soup(random, 1 + trial % 25, size_m, Vec3::Zero()), 400);
  }
}

TEST(DistanceField, IsNeverMoreThanTheDistanceFarFromTheOrigin) {
  testing::Random random(2);
  for (int trial = 0; trial < 30; ++trial) {
    SCOPED_TRACE(trial);
    const double size_m = random.log_uniform(1e-3, 1e3);
    const Vec3 middle = 1e6 * random.direction();
    expect_never_more(random, soup(random, 10, size_m, middle), 400);
  }
}

TEST(DistanceField, IsNeverMoreThanTheDistanceBetweenWalls) {
  testing::Random random(3);
  for (const double thickness_m : {0.0, 1e-9, 1e-4, 0.1}) {
    for (const double scale : {1e-3, 1.0, 10.0}) {
      const double wall_m = thickness_m * scale;
      expect_never_more(random, room(scale, wall_m, Vec3::Zero()), 1000);
      expect_never_more(random, room(scale, wall_m, Vec3(1e6, -1e6, 0.1)), 1000);
    }
  }
}

/// Walls exactly in faces between cells belong to the cells of both sides.
TEST(DistanceField, IsNeverMoreThanTheDistanceToWallsBetweenCells) {
  testing::Random random(4);
  const Mesh outside = room(1.0, 0.0, Vec3::Zero());
  const auto first = DistanceField::build(outside);
  ASSERT_TRUE(first);
  const auto grid = CellGrid::around(outside.bounds(), (*first)->statistics().resolution_m);
  for (int trial = 0; trial < 20; ++trial) {
    Mesh mesh = outside;
    const Vec3 low = snapped_to_faces(random, *grid, Vec3(1.0, 1.0, 0.5));
    const Vec3 high = snapped_to_faces(random, *grid, Vec3(2.0, 2.0, 0.5));
    testing::add_cuboid(mesh, low, high);
    const auto result = DistanceField::build(mesh);
    ASSERT_TRUE(result);
    ASSERT_EQ((*result)->statistics().cells[0], (*first)->statistics().cells[0]);
    checked_mean_loss(random, mesh, **result, 1000);
  }
}

TEST(DistanceField, IsNeverMoreThanTheDistanceToOneTriangle) {
  testing::Random random(5);
  const Vec3 a(0.3, 0.1, 0.2);
  const Vec3 b(1.7, 0.4, -0.9);
  const Vec3 c(0.2, 2.1, 0.4);
  for (const Triangle& triangle :
       {Triangle{a, b, c}, Triangle{a, b, b}, Triangle{a, b, 0.5 * (a + b)},
        Triangle{a, Vec3(1.3, 0.1, 0.2), Vec3(0.3, 1.1, 0.2)}, Triangle{a, Vec3(5, 0.1, 0.2), a}}) {
    expect_never_more(random, mesh_of_triangles({triangle}), 4000);
  }
}

TEST(DistanceField, LosesLessThanACellAndAHalf) {
  testing::Random random(6);
  Mesh mesh = room(1.0, 0.05, Vec3::Zero());
  testing::add_cuboid(mesh, {1.0, 1.0, 0.0}, {2.0, 1.6, 0.7});
  const auto result = DistanceField::build(mesh);
  ASSERT_TRUE(result);
  const double loss = checked_mean_loss(random, mesh, **result, 10000);
  std::cout << "mean loss " << loss << " cells of " << (*result)->statistics().resolution_m
            << " m\n";
  EXPECT_LT(loss, 1.5);
}

TEST(DistanceField, KnowsHowFarAPointOutsideIs) {
  const Mesh mesh = room(1.0, 0.1, Vec3::Zero());
  const auto result = DistanceField::build(mesh);
  ASSERT_TRUE(result);
  const double resolution_m = (*result)->statistics().resolution_m;
  for (const double away_m : {1.0, 1e3, 1e9, 1e90, 1e150, 1e300}) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Vec3 point(2.0, 1.5, 1.0);
        point[axis] = side * away_m + (side > 0.0 ? mesh.bounds().max()[axis] : 0.0);
        const oracle::Real distance_m = true_distance_m(mesh, point);
        const double bound_m = (*result)->clearance_at_least_m(point);
        EXPECT_LE(static_cast<oracle::Real>(bound_m), distance_m);
        // From about 1e90 on a nearer point replaces it.
        EXPECT_GE(bound_m, std::min(away_m * (1.0 - 1e-12), 1e90) - resolution_m);
      }
    }
  }
}

TEST(DistanceField, KnowsNothingOfPointsThatAreNotFinite) {
  const auto result = DistanceField::build(room(1.0, 0.1, Vec3::Zero()));
  ASSERT_TRUE(result);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kBeyond_m, -kBeyond_m}) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (const double other_m : {1.0, -100.0}) {
        Vec3 point = Vec3::Constant(other_m);
        point[axis] = bad;
        EXPECT_EQ((*result)->clearance_at_least_m(point), 0.0);
      }
    }
  }
}

TEST(DistanceField, StaysWithinTheMemoryAllowed) {
  testing::Random random(7);
  const Mesh mesh = soup(random, 200, 10.0, Vec3::Zero());
  double coarser_m = kBeyond_m;
  for (const std::size_t limit : {3000U, 10'000U, 50'000U}) {
    DistanceFieldOptions options;
    options.memory_limit_bytes = limit;
    const auto result = DistanceField::build(mesh, options);
    if (!result) continue;
    const DistanceFieldStatistics& statistics = (*result)->statistics();
    EXPECT_LE(statistics.memory_bytes, limit);
    EXPECT_GT(2 * statistics.memory_bytes, limit) << "it uses what it may";
    EXPECT_LT(statistics.resolution_m, coarser_m);
    coarser_m = statistics.resolution_m;
  }
  EXPECT_LT(coarser_m, kBeyond_m) << "none was built";
}

TEST(DistanceField, IsTheSameForAnyNumberOfThreads) {
  testing::Random random(8);
  const Mesh mesh = soup(random, 3000, 10.0, Vec3::Zero());
  DistanceFieldOptions options;
  options.threads = 1;
  const auto one = DistanceField::build(mesh, options);
  ASSERT_TRUE(one) << one.error;
  for (const unsigned threads : {2U, 7U}) {
    options.threads = threads;
    const auto many = DistanceField::build(mesh, options);
    ASSERT_TRUE(many);
    EXPECT_EQ((*many)->statistics(), (*one)->statistics());
    for (int i = 0; i < 20000; ++i) {
      const Vec3 point = point_about(random, mesh.bounds());
      ASSERT_EQ((*many)->clearance_at_least_m(point), (*one)->clearance_at_least_m(point));
    }
  }
}

TEST(DistanceField, IsOffWhereThereIsNothingToKnow) {
  EXPECT_THAT(DistanceField::build(Mesh()).error, HasSubstr("no triangles"));
  const Vec3 p(1, 2, 3);
  EXPECT_THAT(DistanceField::build(mesh_of_triangles({{p, p, p}})).error, HasSubstr("no grid"));
  DistanceFieldOptions options;
  options.memory_limit_bytes = 0;
  const auto none = DistanceField::build(room(1.0, 0.1, Vec3::Zero()), options);
  EXPECT_THAT(none.error, HasSubstr("no grid"));
  EXPECT_FALSE(none);
}

TEST(DistanceField, IsOffWhereTheSceneFillsItsBox) {
  std::vector<Triangle> sheets;
  for (int i = 0; i <= 40; ++i) {
    const double z = 0.1 * i;
    sheets.push_back({Vec3(0, 0, z), Vec3(4, 0, z), Vec3(0, 4, z)});
    sheets.push_back({Vec3(4, 4, z), Vec3(4, 0, z), Vec3(0, 4, z)});
  }
  const auto result = DistanceField::build(mesh_of_triangles(sheets));
  EXPECT_FALSE(result);
  EXPECT_THAT(result.error, HasSubstr("0.0 % of the cells of 0.1"));
  EXPECT_THAT(result.error, HasSubstr("does not pay"));
}

/// The allowed effort makes the cells coarse; otherwise these scenes would take minutes.
TEST(DistanceField, SpendsBoundedEffortOnHostileScenes) {
  testing::Random random(10);
  constexpr std::size_t kCopies = 100'000;
  const Triangle huge{Vec3(-50, -40, -30), Vec3(50, 45, -20), Vec3(-10, 30, 60)};
  std::vector<Triangle> copies(kCopies, huge);
  std::vector<Triangle> fan;
  std::vector<Triangle> dust{huge};
  for (std::size_t i = 0; i < kCopies; ++i) {
    fan.push_back({Vec3::Zero(), 50.0 * random.direction(), 50.0 * random.direction()});
    const Vec3 at = 50.0 * random.direction();
    dust.push_back({at, at + 1e-4 * random.direction(), at});
  }
  for (const std::vector<Triangle>* triangles : {&copies, &fan, &dust}) {
    const Mesh mesh = mesh_of_triangles(*triangles);
    const auto result = DistanceField::build(mesh);
    if (!result) {
      EXPECT_THAT(result.error, HasSubstr("does not pay"));
      continue;
    }
    const double resolution_m = (*result)->statistics().resolution_m;
    EXPECT_LE(surface_extent(mesh, 1).effort(resolution_m),
              DistanceField::kEffort + DistanceField::kEffortPerTriangle * (kCopies + 1));
    for (int i = 0; i < 10; ++i) {
      const Vec3 point = point_about(random, mesh.bounds());
      EXPECT_LE(static_cast<oracle::Real>((*result)->clearance_at_least_m(point)),
                true_distance_m(mesh, point));
    }
  }
}

/// A body beside a flat scene is outside of its box, where the field knows much.
TEST(DistanceField, IsOnForFlatScenes) {
  const Mesh floor = mesh_of_triangles({{Vec3(0, 0, 0), Vec3(9, 0, 0), Vec3(0, 9, 0)},
                                        {Vec3(9, 9, 0), Vec3(9, 0, 0), Vec3(0, 9, 0)}});
  const auto result = DistanceField::build(floor);
  ASSERT_TRUE(result) << result.error;
  const double bound_m = (*result)->clearance_at_least_m({4, 4, 2});
  EXPECT_LE(bound_m, 2.0);
  EXPECT_GE(bound_m, 2.0 - (*result)->statistics().resolution_m);
}

}  // namespace
}  // namespace camway::scene
