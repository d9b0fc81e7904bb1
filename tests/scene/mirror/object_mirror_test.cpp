// SPDX-License-Identifier: MIT
#include "daemon/scene/mirror/object_mirror.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "daemon/scene/mirror/box_costs.h"
#include "daemon/scene/mirror/scene_mirror.h"
#include "tests/scene/voxels/voxel_oracle.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;
using oracle::Real;
using ::testing::HasSubstr;

constexpr std::uint64_t kMirrorSeed = 77003;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Mesh mesh_of(const std::vector<Triangle>& triangles) {
  Mesh mesh;
  for (const Triangle& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), triangle.begin(), triangle.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.objects.push_back({"test", 0, static_cast<std::uint32_t>(triangles.size())});
  return mesh;
}

std::shared_ptr<const ObjectMirror> build(const Mesh& mesh, double resolution_m) {
  ObjectMirror::BuildResult result = ObjectMirror::build(mesh, resolution_m);
  EXPECT_TRUE(result.map) << result.error;
  EXPECT_TRUE(result.error.empty());
  return result.map;
}

Vec3 voxel_center(const Voxel& voxel, double resolution_m) {
  return (Vec3(voxel[0], voxel[1], voxel[2]).array() + 0.5).matrix() * resolution_m;
}

/// A random small scene with the list of its occupied voxels, found by testing every voxel.
struct MirroredObject {
  double resolution_m = 0.0;
  Mesh mesh;
  std::shared_ptr<const ObjectMirror> map;
  std::vector<Voxel> occupied;
  double face_error_m = 0.0;  ///< an upper bound for all faces

  explicit MirroredObject(testing::Random& random) {
    resolution_m = random.log_uniform(1e-3, 10.0);
    mesh = oracle::random_mesh(random, resolution_m, 1 + static_cast<int>(random() % 4));
    map = build(mesh, resolution_m);
    for (const Voxel& voxel : oracle::voxels_around(mesh, resolution_m, 1)) {
      if (map->occupied_at(voxel_center(voxel, resolution_m))) occupied.push_back(voxel);
    }
    face_error_m = VoxelGrid(resolution_m).face_error_m(40);
  }

  [[nodiscard]] oracle::RealBox box(const Voxel& voxel, Real margin_m = 0) const {
    return oracle::voxel_box(voxel, resolution_m, margin_m);
  }

  /// Returns a point inside, beside or far from the mesh, often on a face.
  [[nodiscard]] Vec3 point(testing::Random& random) const {
    const double reach_m = resolution_m * random.log_uniform(1.0, 100.0);
    Vec3 p = reach_m * random.direction();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (random() % 4 == 0) p[axis] = std::round(p[axis] / resolution_m) * resolution_m;
    }
    return p;
  }
};

TEST(ObjectMirror, OccupiesWhatTheTrianglesTouch) {
  testing::Random random(kMirrorSeed);
  for (int trial = 0; trial < 300; ++trial) {
    const MirroredObject sample(random);
    std::set<Voxel> expected;
    for (std::size_t i = 0; i < sample.mesh.triangles.size(); ++i) {
      for_each_voxel_touched(VoxelGrid(sample.resolution_m), sample.mesh.triangle(i),
                             [&](const Voxel& voxel) {
                               expected.insert(voxel);
                               return true;
                             });
    }
    ASSERT_EQ(std::set<Voxel>(sample.occupied.begin(), sample.occupied.end()), expected);
    ASSERT_EQ(sample.map->statistics().occupied_voxels, expected.size());
  }
}

/// The promise of the map: no point of the scene is in free space.
TEST(ObjectMirror, EveryPointOfATriangleIsOccupiedAndNoDistanceIsTooLong) {
  testing::Random random(kMirrorSeed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const MirroredObject sample(random);
    for (int i = 0; i < 50; ++i) {
      const Triangle triangle = sample.mesh.triangle(random() % sample.mesh.triangles.size());
      double s = unit(random);
      double t = unit(random);
      if (s + t > 1.0) {
        s = 1.0 - s;
        t = 1.0 - t;
      }
      const Vec3 on_triangle =
          triangle[0] + s * (triangle[1] - triangle[0]) + t * (triangle[2] - triangle[0]);
      ASSERT_TRUE(sample.map->occupied_at(on_triangle)) << "trial " << trial;
      ASSERT_TRUE(sample.map->occupied_at(triangle[random() % 3]));

      const Vec3 p = sample.point(random);
      const std::optional<double> distance = sample.map->distance_m(p, kInfinity);
      ASSERT_TRUE(distance);
      for (std::size_t k = 0; k < sample.mesh.triangles.size(); ++k) {
        ASSERT_LE(*distance, oracle::distance_m(p, sample.mesh.triangle(k))) << "trial " << trial;
      }
    }
  }
}

TEST(ObjectMirror, DistanceSphereAndBoxAgreeWithEveryVoxel) {
  testing::Random random(kMirrorSeed);
  for (int trial = 0; trial < 300; ++trial) {
    const MirroredObject sample(random);
    for (int i = 0; i < 30; ++i) {
      const Vec3 p = sample.point(random);
      const Box query(p, p + Vec3(sample.point(random).cwiseAbs() * 0.2));
      Real nearest = HUGE_VALL;
      bool box_exact = false;
      bool box_grown = false;
      for (const Voxel& voxel : sample.occupied) {
        nearest = std::min(nearest, oracle::distance_m(p, sample.box(voxel)));
        const auto meets = [&](const oracle::RealBox& b) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const Eigen::Index k = static_cast<Eigen::Index>(axis);
            if (b.max[axis] < query.min()[k] || b.min[axis] > query.max()[k]) return false;
          }
          return true;
        };
        box_exact |= meets(sample.box(voxel));
        box_grown |= meets(sample.box(voxel, sample.face_error_m));
      }
      const double distance = sample.map->distance_m(p, kInfinity).value();
      ASSERT_LE(distance, nearest);
      ASSERT_GE(distance, nearest * (1 - static_cast<Real>(ObjectMirror::kDistanceRelativeError)) -
                              2 * static_cast<Real>(sample.face_error_m));
      EXPECT_TRUE(sample.map->occupied_in_sphere(p, distance));
      EXPECT_EQ(sample.map->distance_m(p, distance), distance);
      if (distance > 0.0) {
        EXPECT_FALSE(sample.map->occupied_in_sphere(p, std::nextafter(distance, 0.0)));
      }
      const bool in_box = sample.map->occupied_in_box(query);
      ASSERT_TRUE(in_box || !box_exact);
      ASSERT_TRUE(!in_box || box_grown);
    }
  }
}

/// The searches skip nothing of relevance: their answers equal those of a test of every cube.
TEST(ObjectMirror, SearchesAnswerAsAskingEveryCubeDoes) {
  testing::Random random(kMirrorSeed);
  for (int trial = 0; trial < 300; ++trial) {
    const MirroredObject sample(random);
    const VoxelGrid grid(sample.resolution_m);
    const auto least = [&](const auto& cost, double limit) {
      double cheapest = kInfinity;
      sample.map->tree().for_each_cube([&](const VoxelCube& cube) {
        const Box box = grid.box(cube);
        const auto along = [&](Eigen::Index k) {
          return cost.along(k, box.min()[k], box.max()[k]);
        };
        cheapest = std::min(cheapest, cost.total(along(0), along(1), along(2)));
      });
      return cheapest <= limit ? cheapest : kInfinity;
    };
    for (int i = 0; i < 30; ++i) {
      const Vec3 p = sample.point(random);
      const Vec3 to = sample.point(random);
      const double limit = sample.resolution_m * random.log_uniform(0.1, 100.0);
      ASSERT_EQ(sample.map->distance_m(p, limit).value_or(kInfinity),
                least(PointDistance(p), limit));
      ASSERT_EQ(sample.map->occupied_in_sphere(p, limit), least(PointDistance(p), limit) <= limit);
      if (to.isZero(0.0)) continue;
      ASSERT_EQ(sample.map->ray_hit_m(p, to, limit).value_or(kInfinity),
                least(RayEntry(p, to), limit));
    }
  }
}

/// The answer is between the entries into the voxels grown by the face error and into the exact
/// ones.
TEST(ObjectMirror, RayAgreesWithEveryVoxel) {
  testing::Random random(kMirrorSeed);
  int hits = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const MirroredObject sample(random);
    for (int i = 0; i < 60; ++i) {
      const Vec3 origin = sample.point(random);
      Vec3 direction = 0.3 * sample.point(random) - origin;
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (random() % 3 == 0) direction[axis] = 0.0;
      }
      if (direction.isZero(0.0)) continue;
      Real exact = HUGE_VALL;
      Real grown = HUGE_VALL;
      for (const Voxel& voxel : sample.occupied) {
        const Real e = oracle::ray_entry_m(origin, direction, sample.box(voxel));
        if (e >= 0) exact = std::min(exact, e);
        const Real margin_m = 2 * static_cast<Real>(sample.face_error_m);
        const Real g = oracle::ray_entry_m(origin, direction, sample.box(voxel, margin_m));
        if (g >= 0) grown = std::min(grown, g);
      }
      const double hit = sample.map->ray_hit_m(origin, direction, kInfinity).value_or(kInfinity);
      ASSERT_LE(hit, exact) << "trial " << trial << ": passed through an occupied voxel";
      ASSERT_GE(hit, grown * (1 - static_cast<Real>(ObjectMirror::kDistanceRelativeError)))
          << "trial " << trial;
      if (hit == kInfinity) continue;
      ++hits;
      EXPECT_EQ(sample.map->ray_hit_m(origin, direction, hit), hit);
      if (hit > 0.0) {
        EXPECT_FALSE(sample.map->ray_hit_m(origin, direction, std::nextafter(hit, 0.0)));
      }
    }
  }
  EXPECT_GT(hits, 1000);
}

/// The answer is between the first contact with the voxels and with larger ones beyond all
/// rounding.
TEST(ObjectMirror, SpherePathAgreesWithEveryVoxel) {
  testing::Random random(kMirrorSeed);
  int hits = 0;
  int misses = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const MirroredObject sample(random);
    for (int i = 0; i < 20; ++i) {
      const Vec3 from = sample.point(random);
      Vec3 to = 0.3 * sample.point(random) - (i % 2 == 0 ? from : Vec3(Vec3::Zero()));
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (random() % 3 == 0) to[axis] = from[axis];
      }
      const double radius_m =
          random() % 4 == 0 ? 0.0 : sample.resolution_m * random.log_uniform(1e-3, 10.0);
      // The size of a million roundings of the largest number here.
      const Real more_m = 1e6L * 0x1p-53L * (from.lpNorm<1>() + to.lpNorm<1>());
      Real exact = HUGE_VALL;
      Real grown = HUGE_VALL;
      for (const Voxel& voxel : sample.occupied) {
        const Real e = oracle::ball_way_m(from, to, radius_m, sample.box(voxel));
        if (e >= 0) exact = std::min(exact, e);
        const Real g = oracle::ball_way_m(from, to, radius_m + more_m,
                                          sample.box(voxel, 2 * Real{sample.face_error_m}));
        if (g >= 0) grown = std::min(grown, g);
      }
      const double hit = sample.map->sphere_path_hit_m(from, to, radius_m).value_or(kInfinity);
      ASSERT_LE(hit, exact) << "trial " << trial << ": through an occupied voxel";
      ASSERT_GE(hit, grown * (1 - 1e-9L)) << "trial " << trial << ": too short";
      (hit == kInfinity ? misses : hits) += 1;
      const double straight_m = sample.map->distance_m(from, kInfinity).value();
      EXPECT_EQ(hit == 0.0, straight_m <= radius_m * (1 + 1e-9) + static_cast<double>(more_m));
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(misses, 300);
}

/// One occupied voxel, [2, 3] x [2, 3] x [2, 3] m.
class OneVoxel : public ::testing::Test {
 protected:
  // No coordinate or distance below exceeds 12 m; a ray across a corner meets three moved faces.
  const double entry_error_m =
      12.0 * ObjectMirror::kDistanceRelativeError + 2.0 * VoxelGrid(1.0).face_error_m(3);
  const std::shared_ptr<const ObjectMirror> map =
      build(mesh_of({{Vec3(2.4, 2.5, 2.6), Vec3(2.5, 2.5, 2.6), Vec3(2.5, 2.6, 2.6)}}), 1.0);
  static constexpr double kFar = 1e9;
};

TEST_F(OneVoxel, RayCornerCases) {
  ASSERT_EQ(map->statistics().occupied_voxels, 1U);
  EXPECT_NEAR(map->ray_hit_m({-6, 2.5, 2.5}, {1, 0, 0}, kFar).value(), 8.0, entry_error_m);
  EXPECT_NEAR(map->ray_hit_m({11, 2.5, 2.5}, {-5, 0, 0}, kFar).value(), 8.0, entry_error_m);
  EXPECT_EQ(map->ray_hit_m({2.1, 2.1, 2.1}, {0, 0, 1}, kFar), 0.0) << "starts inside";
  EXPECT_EQ(map->ray_hit_m({3, 2.5, 2.5}, {1, 0, 0}, kFar), 0.0) << "starts on the far face";
  EXPECT_FALSE(map->ray_hit_m({3.1, 2.5, 2.5}, {1, 0, 0}, kFar)) << "behind the origin";
  EXPECT_NEAR(map->ray_hit_m({0, 3, 2.5}, {1, 0, 0}, kFar).value(), 2.0, entry_error_m)
      << "in a face";
  EXPECT_NEAR(map->ray_hit_m({0, 2, 3}, {1, 0, 0}, kFar).value(), 2.0, entry_error_m)
      << "on an edge";
  EXPECT_NEAR(map->ray_hit_m({0, 0, 0}, {1, 1, 1}, kFar).value(), 2 * std::sqrt(3.0),
              entry_error_m);
  EXPECT_NEAR(map->ray_hit_m({1, 4, 3}, {1, -1, 0}, kFar).value(), std::sqrt(2.0), entry_error_m);
  EXPECT_FALSE(map->ray_hit_m({0, 3.0001, 2.5}, {1, 0, 0}, kFar));
}

TEST_F(OneVoxel, RayFromOutsideTheKeysAndRanges) {
  const double away_m = 1e7;  // the keys of 1 m voxels end at 32768 m
  const double expected_m = away_m + 2.0;
  EXPECT_NEAR(map->ray_hit_m({-away_m, 2.5, 2.5}, {1, 0, 0}, kFar).value(), expected_m,
              expected_m * ObjectMirror::kDistanceRelativeError);
  EXPECT_FALSE(map->ray_hit_m({0, 2.5, 2.5}, {1, 0, 0}, 1.999));
  EXPECT_TRUE(map->ray_hit_m({0, 2.5, 2.5}, {1, 0, 0}, 2.0));
  EXPECT_FALSE(map->ray_hit_m({0, 2.5, 2.5}, {1, 0, 0}, -1.0));
  EXPECT_FALSE(map->ray_hit_m({0, 2.5, 2.5}, {0, 1, 0}, kInfinity))
      << "a miss is no hit at infinity";
  const double unscaled = map->ray_hit_m({0, 1, 0}, {2, 1.2, 2.5}, kFar).value();
  for (const int exponent : {-1000, -30, 30, 1000}) {
    const Vec3 direction = Vec3(2, 1.2, 2.5) * std::ldexp(1.0, exponent);
    EXPECT_EQ(map->ray_hit_m({0, 1, 0}, direction, kFar), unscaled) << "2^" << exponent;
  }
}

TEST_F(OneVoxel, SpherePathCornerCases) {
  const auto hit_m = [&](const Vec3& from, const Vec3& to, double radius_m) {
    return map->sphere_path_hit_m(from, to, radius_m);
  };
  // Some 60 roundings of the largest number of the query, here 16 m.
  const double way_error_m = 16.0 * 0x1p-53 * 60.0;
  EXPECT_NEAR(hit_m({-6, 2.5, 2.5}, {10, 2.5, 2.5}, 0.5).value(), 7.5, way_error_m);
  EXPECT_NEAR(hit_m({-6, 2.5, 2.5}, {10, 2.5, 2.5}, 0.0).value(), 8.0, way_error_m);
  EXPECT_EQ(hit_m({2.1, 2.1, 2.1}, {9, 2.1, 2.1}, 0.0), 0.0) << "begins inside";
  EXPECT_EQ(hit_m({4, 2.5, 2.5}, {9, 2.5, 2.5}, 1.0), 0.0) << "begins touching";
  EXPECT_FALSE(hit_m({4, 2.5, 2.5}, {9, 2.5, 2.5}, 0.99)) << "moves away";
  EXPECT_FALSE(hit_m({-6, 2.5, 2.5}, {1, 2.5, 2.5}, 0.99)) << "ends before";
  EXPECT_TRUE(hit_m({-6, 2.5, 2.5}, {1, 2.5, 2.5}, 1.0)) << "ends touching";
  EXPECT_FALSE(hit_m({-6, 3.6, 2.5}, {10, 3.6, 2.5}, 0.59)) << "passes by";
  EXPECT_FALSE(hit_m({-6, 3.6, 3.6}, {10, 3.6, 3.6}, 0.6 * std::sqrt(2.0) - 1e-9));
  EXPECT_NEAR(hit_m({-6, 3.6, 3.6}, {10, 3.6, 3.6}, 1.0).value(),
              8.0 - std::sqrt(1.0 - 2 * 0.6 * 0.6), 1e-9)
      << "by a corner";
  EXPECT_EQ(hit_m({4, 2.5, 2.5}, {4, 2.5, 2.5}, 1.0), 0.0) << "does not move";
  EXPECT_FALSE(hit_m({4, 2.5, 2.5}, {4, 2.5, 2.5}, 0.99)) << "does not move";
  EXPECT_EQ(hit_m({1e308, 2.5, 2.5}, {-1e308, 2.5, 2.5}, 0.5), 0.0) << "nothing is known";
  EXPECT_EQ(hit_m({4, 2.5, 2.5}, {9, 2.5, 2.5}, kInfinity), 0.0);
  EXPECT_FALSE(hit_m({4, 2.5, 2.5}, {kNaN, 2.5, 2.5}, 1.0));
  EXPECT_FALSE(hit_m({2.5, 2.5, 2.5}, {4, 2.5, 2.5}, -1.0));
}

TEST_F(OneVoxel, NonsenseIsAnsweredAsDocumented) {
  const Vec3 nan(kNaN, 2.5, 2.5);
  const Vec3 inside(2.5, 2.5, 2.5);
  EXPECT_FALSE(map->occupied_at(nan));
  EXPECT_FALSE(map->occupied_at({kInfinity, 2.5, 2.5}));
  EXPECT_FALSE(map->occupied_at({1e300, 2.5, 2.5}));
  EXPECT_FALSE(map->occupied_in_sphere(nan, 1.0));
  EXPECT_FALSE(map->occupied_in_sphere(inside, kNaN));
  EXPECT_FALSE(map->occupied_in_sphere(inside, -1.0));
  EXPECT_TRUE(map->occupied_in_sphere({1e200, 0, 0}, kInfinity));
  EXPECT_FALSE(map->distance_m(inside, kNaN));
  EXPECT_FALSE(map->distance_m(nan, 1.0));
  EXPECT_FALSE(map->ray_hit_m(nan, {1, 0, 0}, 1.0));
  EXPECT_FALSE(map->ray_hit_m(inside, nan, 1.0));
  EXPECT_FALSE(map->ray_hit_m(inside, {0, 0, 0}, 1.0));
  EXPECT_FALSE(map->ray_hit_m(inside, {kInfinity, 0, 0}, 1.0));
  EXPECT_FALSE(map->ray_hit_m(inside, {1, 0, 0}, kNaN));
  EXPECT_FALSE(map->occupied_in_box(Box()));
  EXPECT_FALSE(map->occupied_in_box(Box(Vec3(3, 3, 3), Vec3(2, 2, 2))));
  EXPECT_FALSE(map->occupied_in_box(Box(nan, Vec3(3, 3, 3))));
  EXPECT_TRUE(map->occupied_in_box(Box(Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity))));
}

TEST(ObjectMirror, AnEmptySceneIsFreeEverywhere) {
  const std::shared_ptr<const ObjectMirror> map = build(Mesh{}, 0.1);
  EXPECT_FALSE(map->occupied_at({0, 0, 0}));
  EXPECT_FALSE(map->distance_m({0, 0, 0}, kInfinity));
  EXPECT_FALSE(map->ray_hit_m({0, 0, 0}, {1, 0, 0}, kInfinity));
  EXPECT_EQ(map->statistics().occupied_voxels, 0U);
}

TEST(ObjectMirror, RefusesWhatItCannotHold) {
  const Mesh far = mesh_of({{Vec3(0, 0, 0), Vec3(0, 1700, 0), Vec3(1, 0, 0)}});
  const ObjectMirror::BuildResult beyond = ObjectMirror::build(far, 0.05);
  EXPECT_EQ(beyond.map, nullptr);
  EXPECT_THAT(beyond.error, HasSubstr("1700"));
  EXPECT_THAT(beyond.error, HasSubstr("0.05"));
  EXPECT_THAT(beyond.error, HasSubstr("1638.4 m"));
  EXPECT_TRUE(ObjectMirror::build(far, 0.1).map);

  const ObjectMirror::BuildResult many = ObjectMirror::build(far, 0.1, std::nullopt, 1000);
  EXPECT_EQ(many.map, nullptr);
  EXPECT_THAT(many.error, HasSubstr("more than 1000 voxels"));
  EXPECT_THAT(many.error, HasSubstr("1700"));

  for (const double resolution_m : {0.0, -0.1, kNaN, kInfinity, 1e-300, 1e300}) {
    const ObjectMirror::BuildResult bad = ObjectMirror::build(far, resolution_m);
    EXPECT_EQ(bad.map, nullptr);
    EXPECT_THAT(bad.error, HasSubstr("resolution"));
  }
}

// Filling the last one would take hours.
TEST(ObjectMirror, KnowsFromTheLargestTriangleWhatIsHopeless) {
  testing::Random random(kMirrorSeed);
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  for (int run = 0; run < 30; ++run) {
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      for (double& coordinate : corner) coordinate = place(random);
    }
    const Mesh mesh = mesh_of({{corners[0], corners[1], corners[2]}});
    const std::uint64_t voxels = build(mesh, 0.05)->statistics().occupied_voxels;
    EXPECT_TRUE(ObjectMirror::build(mesh, 0.05, std::nullopt, voxels).map) << "never too early";
  }
  const Mesh floor = mesh_of({{Vec3(0, 0, 0), Vec3(30, 0, 0), Vec3(0, 30, 0)}});
  const ObjectMirror::BuildResult result =
      ObjectMirror::build(floor, 0.001, std::nullopt, 300'000'000);
  EXPECT_FALSE(result.map);
  EXPECT_THAT(result.error, HasSubstr("more than 300000000 voxels"));
}

TEST(ObjectMirror, IsNotMadeAfterAStop) {
  std::stop_source stop;
  stop.request_stop();
  testing::Random random(kMirrorSeed);
  const Mesh mesh = oracle::random_mesh(random, 0.1, 5);
  VoxelSet voxels;
  voxels.insert(Voxel{1, 2, 3});
  const auto map = VoxelMap::build(0.1, voxels, {}, UnknownSpace::kFree).map;
  for (const ObjectMirror::BuildResult& result :
       {ObjectMirror::build(mesh, 0.1, std::nullopt, 1000, stop.get_token()),
        ObjectMirror::of_map(*map, {}, 1000, nullptr, nullptr, stop.get_token())}) {
    EXPECT_EQ(result.map, nullptr);
    EXPECT_THAT(result.error, HasSubstr("cancelled"));
    EXPECT_EQ(result.limit, Limit::kNone);
  }
}

TEST(ObjectMirror, TheVoxelLimitIsExact) {
  testing::Random random(kMirrorSeed);
  const Mesh mesh = oracle::random_mesh(random, 0.1, 5);
  const std::uint64_t voxels = build(mesh, 0.1)->statistics().occupied_voxels;
  EXPECT_TRUE(ObjectMirror::build(mesh, 0.1, std::nullopt, voxels).map);
  EXPECT_FALSE(ObjectMirror::build(mesh, 0.1, std::nullopt, voxels - 1).map);
}

/// Returns the leaves of a tree as OctoMap has them: key of the lowest voxel and depth.
std::vector<std::array<int, 4>> occupied_leaves(const octomap::OcTree& tree) {
  std::vector<std::array<int, 4>> leaves;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const octomap::OcTreeKey key = leaf.getIndexKey();
    if (tree.isNodeOccupied(*leaf)) {
      leaves.push_back({key[0], key[1], key[2], static_cast<int>(leaf.getDepth())});
    }
  }
  std::sort(leaves.begin(), leaves.end());
  return leaves;
}

std::string written(const std::shared_ptr<const ObjectMirror>& map, const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / name;
  EXPECT_EQ(SceneMirror(map).write_bt(file), "");
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST(ObjectMirror, OctoMapReadsBackWhatIsWritten) {
  testing::Random random(kMirrorSeed);
  for (const double resolution_m : {0.05, 1.0 / 3.0, 0.123456789}) {
    Mesh mesh = oracle::random_mesh(random, resolution_m, 6);
    // A point at the centre of an aligned block of eight voxels: it touches all, and they are
    // pruned.
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(Vec3::Constant(101 * resolution_m));
    mesh.triangles.push_back({first, first, first});
    const std::shared_ptr<const ObjectMirror> map = build(mesh, resolution_m);
    const std::filesystem::path file =
        std::filesystem::path(::testing::TempDir()) / "round_trip.bt";
    ASSERT_EQ(SceneMirror(map).write_bt(file), "");

    octomap::OcTree tree(1.0);
    ASSERT_TRUE(tree.readBinary(file.string()));
    EXPECT_EQ(tree.getResolution(), resolution_m) << "to the last bit";
    std::uint64_t voxels = 0;
    bool pruned = false;
    for (const std::array<int, 4>& leaf : occupied_leaves(tree)) {
      const int edge = 1 << (16 - leaf[3]);
      pruned |= edge > 1;
      for (int i = 0; i < edge * edge * edge; ++i, ++voxels) {
        const Voxel voxel{leaf[0] + i % edge - 32768, leaf[1] + i / edge % edge - 32768,
                          leaf[2] + i / edge / edge - 32768};
        ASSERT_TRUE(map->occupied_at(voxel_center(voxel, resolution_m)));
      }
    }
    EXPECT_EQ(voxels, map->statistics().occupied_voxels);
    EXPECT_TRUE(pruned);
  }
}

TEST(ObjectMirror, FailureToWriteNamesTheFile) {
  const std::shared_ptr<const ObjectMirror> map = build(Mesh{}, 0.1);
  EXPECT_THAT(SceneMirror(map).write_bt("/nonexistent/folder/map.bt"),
              HasSubstr("/nonexistent/folder/map.bt"));
}

/// The map depends on the set of triangles only.
TEST(ObjectMirror, TheSameSceneGivesTheSameBytes) {
  testing::Random random(kMirrorSeed);
  Mesh mesh = oracle::random_mesh(random, 0.1, 20);
  const std::string bytes = written(build(mesh, 0.1), "first.bt");
  EXPECT_EQ(written(build(mesh, 0.1), "again.bt"), bytes);
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  for (std::array<std::uint32_t, 3>& t : mesh.triangles) std::swap(t[0], t[2]);
  EXPECT_EQ(written(build(mesh, 0.1), "shuffled.bt"), bytes);
}

}  // namespace
}  // namespace camway::scene
