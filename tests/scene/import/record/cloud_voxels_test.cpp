// SPDX-License-Identifier: MIT
#include "daemon/scene/import/record/cloud_voxels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "daemon/scene/voxels/voxel_grid.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

using camway::testing::Random;
using geometry::Vec3;
using ::testing::HasSubstr;

constexpr std::uint64_t kCloudSeed = 20261126;

std::vector<Vec3> points_about(Random& random, const Vec3& middle, double half, int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(middle + random.in_cube(half));
  return points;
}

/// Whether the closed voxel, its faces rounded as those of a placed map, contains the coordinate.
bool holds(std::int32_t voxel, double origin_m, double voxel_m, double at_m) {
  const double low_m = voxel * voxel_m;
  const double high_m = (voxel + 1) * voxel_m;
  return low_m + origin_m <= at_m && at_m <= high_m + origin_m;
}

bool holds(const Voxel& voxel, const CloudVoxels& cloud, double voxel_m, const Vec3& point) {
  return holds(voxel[0], cloud.origin_m.x(), voxel_m, point.x()) &&
         holds(voxel[1], cloud.origin_m.y(), voxel_m, point.y()) &&
         holds(voxel[2], cloud.origin_m.z(), voxel_m, point.z());
}

/// Compares each point with each voxel.
void expect_tight(const CloudVoxels& cloud, double voxel_m, const std::vector<Vec3>& points) {
  std::vector<Voxel> voxels;
  cloud.voxels.for_each([&](const Voxel& voxel) { voxels.push_back(voxel); });
  EXPECT_LE(voxels.size(), points.size());
  for (const Vec3& point : points) {
    EXPECT_TRUE(std::ranges::any_of(voxels, [&](const Voxel& voxel) {
      return holds(voxel, cloud, voxel_m, point);
    })) << point.transpose();
  }
  for (const Voxel& voxel : voxels) {
    EXPECT_TRUE(std::ranges::any_of(
        points, [&](const Vec3& point) { return holds(voxel, cloud, voxel_m, point); }));
    for (const std::int32_t at : voxel) {
      EXPECT_TRUE(at > VoxelGrid::kMinVoxel && at < VoxelGrid::kMaxVoxel);
    }
  }
}

TEST(CloudVoxels, HoldEachPointAndEachHoldsOne) {
  Random random(kCloudSeed);
  for (int trial = 0; trial < 200; ++trial) {
    const double voxel_m = random.log_uniform(1e-3, 1e3);
    const double far_m = random.chance(0.3) ? 0.0 : random.log_uniform(1e-2, 1e8) * voxel_m;
    const std::vector<Vec3> points = points_about(random, far_m * random.direction(),
                                                  random.log_uniform(1e-3, 15'000.0) * voxel_m, 40);
    const auto cloud = voxels_of_cloud(points, voxel_m);
    ASSERT_TRUE(cloud) << cloud.error;
    ASSERT_NO_FATAL_FAILURE(expect_tight(*cloud, voxel_m, points));
  }
}

TEST(CloudVoxels, HoldPointsOnTheirFaces) {
  Random random(kCloudSeed);
  for (int trial = 0; trial < 200; ++trial) {
    const double voxel_m = random.chance(0.5) ? 0.1 : random.log_uniform(1e-3, 1.0);
    const double far = random.chance(0.5) ? 0.0 : std::round(random.uniform(-1e7, 1e7));
    std::vector<Vec3> points;
    for (int i = 0; i < 30; ++i) {
      Vec3 point;
      for (double& at : point) {
        at = (far + random.integer(-50, 50)) * voxel_m;
        if (random.chance(0.3)) at = std::nextafter(at, random.chance(0.5) ? -1e300 : 1e300);
      }
      points.push_back(point);
    }
    const auto cloud = voxels_of_cloud(points, voxel_m);
    ASSERT_TRUE(cloud) << cloud.error;
    ASSERT_NO_FATAL_FAILURE(expect_tight(*cloud, voxel_m, points));
  }
}

TEST(CloudVoxels, BeginAtTheOriginWhereverTheyCan) {
  const auto near = voxels_of_cloud(std::vector<Vec3>{{3200.0, -3200.0, 0.05}}, 0.1);
  ASSERT_TRUE(near);
  EXPECT_EQ(near->origin_m, Vec3(0.0, 0.0, 0.0));
  const auto far = voxels_of_cloud(std::vector<Vec3>{{3300.0, -3200.0, 0.05}}, 0.1);
  ASSERT_TRUE(far);
  EXPECT_EQ(far->origin_m, Vec3(3300.0, 0.0, 0.0));
  EXPECT_TRUE(far->voxels.contains({0, -32000, 0}));
}

TEST(CloudVoxels, SayHowLargeTheyMustBeAtLeast) {
  Random random(kCloudSeed);
  for (int trial = 0; trial < 50; ++trial) {
    const double half = random.log_uniform(1.0, 1e6);
    const double far = random.chance(0.5) ? 0.0 : 1e15 * half;
    const auto points = points_about(random, Vec3(far, 0.0, 0.0), half, 20);
    const double voxel_m = far != 0.0 ? half : half / 40'000.0;
    const auto cloud = voxels_of_cloud(points, voxel_m);
    ASSERT_FALSE(cloud);
    const std::string_view words = "voxel_m must be ";
    const std::size_t at = cloud.error.find(words);
    ASSERT_NE(at, std::string::npos) << cloud.error;
    const double least_m = std::strtod(cloud.error.c_str() + at + words.size(), nullptr);
    EXPECT_GT(least_m, voxel_m);
    const auto wider = voxels_of_cloud(points, least_m);
    EXPECT_TRUE(wider) << cloud.error << "; then: " << wider.error;
    EXPECT_TRUE(voxels_of_cloud(points, usual_voxel_m(points)));
  }
}

TEST(CloudVoxels, OfTheUsualSizeAreTwiceTheDistanceOfNeighbours) {
  std::vector<Vec3> wall;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 60; ++k) wall.push_back({1.0, 0.0123 * i, 0.0123 * k});
  }
  EXPECT_EQ(usual_voxel_m(wall), 0.025);
  // Points that were recorded twice are no neighbours of each other.
  std::vector<Vec3> twice = wall;
  twice.insert(twice.end(), wall.begin(), wall.end());
  EXPECT_EQ(usual_voxel_m(twice), 0.025);
  EXPECT_EQ(usual_voxel_m(std::vector<Vec3>(5, Vec3(1.0, 2.0, 3.0))), 0.01);
  EXPECT_EQ(usual_voxel_m({}), 0.01);
  EXPECT_EQ(usual_voxel_m(std::vector<Vec3>{{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}}), 1.0);
}

TEST(CloudVoxels, OfTheUsualSizeDependOnTheSetOfPointsAlone) {
  Random random(kCloudSeed);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vec3> points = points_about(random, random.in_cube(10.0), 1.0, 3000);
    const double voxel_m = usual_voxel_m(points);
    std::shuffle(points.begin(), points.end(), random);
    EXPECT_EQ(usual_voxel_m(points), voxel_m);
    // The median of an exact search, of all points.
    std::vector<double> distances;
    for (std::size_t i = 0; i < points.size(); i += 7) {
      double least = 1e9;
      for (std::size_t k = 0; k < points.size(); ++k) {
        if (k != i) least = std::min(least, (points[i] - points[k]).norm());
      }
      distances.push_back(least);
    }
    std::ranges::sort(distances);
    EXPECT_NEAR(voxel_m, 2.0 * distances[distances.size() / 2], 0.15 * voxel_m);
  }
}

TEST(CloudVoxels, OfPointsInOnePlaneAreFoundInTime) {
  // All have the same coordinate along the axis that is searched: each is near all others there.
  std::vector<Vec3> points;
  for (int i = 0; i < 200'000; ++i) points.push_back({0.0, 1e-9 * (i % 447), 1e-9 * (i / 447)});
  EXPECT_GT(usual_voxel_m(points), 0.0);
}

}  // namespace
}  // namespace camway::scene
