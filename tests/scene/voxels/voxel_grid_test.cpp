// SPDX-License-Identifier: MIT
#include "daemon/scene/voxels/voxel_grid.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <set>

#include "tests/scene/voxels/voxel_oracle.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

using geometry::Triangle;
using geometry::Vec3;

constexpr std::uint64_t kGridSeed = 20061;

std::set<Voxel> touched(const VoxelGrid& grid, const Triangle& triangle) {
  std::set<Voxel> voxels;
  EXPECT_TRUE(for_each_voxel_touched(grid, triangle, [&](const Voxel& voxel) {
    EXPECT_TRUE(voxels.insert(voxel).second) << "visited twice";
    return true;
  }));
  return voxels;
}

/// Every coordinate maps to OctoMap's voxel, also within an ulp of a face.
TEST(VoxelGrid, MapsCoordinatesAsOctoMapDoes) {
  testing::Random random(kGridSeed);
  for (const double resolution_m : {0.05, 0.1, 1.0 / 3.0, 0.07, 2.5, 1e-3}) {
    const VoxelGrid grid(resolution_m);
    const octomap::OcTree tree(resolution_m);
    std::uniform_int_distribution<int> index(-32767, 32767);
    for (int i = 0; i < 20000; ++i) {
      double coordinate_m = index(random) * resolution_m;
      if (i % 4 == 1) coordinate_m = std::nextafter(coordinate_m, -HUGE_VAL);
      if (i % 4 == 2) coordinate_m = std::nextafter(coordinate_m, HUGE_VAL);
      if (i % 4 == 3) coordinate_m += random.log_uniform(1e-12, 1.0) * resolution_m;
      const std::optional<std::int32_t> voxel = grid.voxel_of(coordinate_m);
      ASSERT_TRUE(voxel.has_value());
      ASSERT_EQ(*voxel + 32768, static_cast<int>(tree.coordToKey(coordinate_m))) << coordinate_m;
      const geometry::Box box = grid.box({{*voxel, *voxel, *voxel}, 1});
      ASSERT_LE(box.min().x(), coordinate_m);
      ASSERT_GE(box.max().x(), coordinate_m);
    }
  }
}

TEST(VoxelGrid, KnowsWhereTheKeysEnd) {
  const VoxelGrid grid(0.5);
  EXPECT_EQ(grid.voxel_of(-16384.0), VoxelGrid::kMinVoxel);
  EXPECT_EQ(grid.voxel_of(std::nextafter(16384.0, 0.0)), VoxelGrid::kMaxVoxel);
  EXPECT_FALSE(grid.voxel_of(16384.0));
  EXPECT_FALSE(grid.voxel_of(-16384.01));
  EXPECT_FALSE(grid.voxel_of(1e300));
  EXPECT_FALSE(grid.voxel_of(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(grid.voxel_of(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(voxels_touching(grid, -16384.0, 0.0)) << "its face touches a voxel without a key";
  EXPECT_TRUE(voxels_touching(grid, -16383.9, 16383.9));
}

TEST(VoxelGrid, BoxesOfChildrenNestBitForBit) {
  testing::Random random(kGridSeed);
  for (const double resolution_m : {0.05, 1.0 / 3.0, 7.1}) {
    const VoxelGrid grid(resolution_m);
    for (int i = 0; i < 2000; ++i) {
      VoxelCube cube = VoxelGrid::kRoot;
      while (cube.size > 1) {
        const VoxelCube child = cube.child(static_cast<unsigned>(random() % 8));
        ASSERT_TRUE(grid.box(cube).contains(grid.box(child)));
        cube = child;
      }
    }
  }
}

TEST(ForEachVoxelTouched, FaceEdgeAndCornerTouchAllNeighbours) {
  const VoxelGrid grid(0.1);
  const double face_m = 7 * 0.1;
  const Vec3 p(0.32, 0.43, face_m);
  EXPECT_EQ(touched(grid, {p, p, p}), (std::set<Voxel>{{3, 4, 6}, {3, 4, 7}}));
  const Vec3 e(0.32, -face_m, face_m);
  EXPECT_EQ(touched(grid, {e, e, e}).size(), 4U);
  const Vec3 c(face_m, -face_m, face_m);
  EXPECT_EQ(touched(grid, {c, c, c}).size(), 8U);
  const Triangle in_face{Vec3(0.31, 0.42, face_m), Vec3(0.38, 0.42, face_m),
                         Vec3(0.33, 0.47, face_m)};
  EXPECT_EQ(touched(grid, in_face), (std::set<Voxel>{{3, 4, 6}, {3, 4, 7}}));
}

/// Finds every voxel of exact clipping, and no voxel beyond the stated error.
TEST(ForEachVoxelTouched, AgreesWithClippingEveryVoxel) {
  testing::Random random(kGridSeed);
  std::size_t on_border = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const double resolution_m = random.log_uniform(1e-3, 10.0);
    const VoxelGrid grid(resolution_m);
    const Mesh mesh = oracle::random_mesh(random, resolution_m, 1);
    const Triangle triangle = mesh.triangle(0);
    const std::set<Voxel> found = touched(grid, triangle);
    for (const Voxel& voxel : oracle::voxels_around(mesh, resolution_m, 2)) {
      const bool exact = oracle::touches(triangle, oracle::voxel_box(voxel, resolution_m, 0));
      const bool has = found.contains(voxel);
      ASSERT_TRUE(has || !exact) << "trial " << trial << ": a touched voxel is missing";
      if (has && !exact) {
        ++on_border;
        // Coordinates are below 20 voxels; the separating-axis test has a smaller error than the
        // face test.
        const double margin_m = 4.0 * grid.face_error_m(20);
        ASSERT_TRUE(oracle::touches(triangle, oracle::voxel_box(voxel, resolution_m, margin_m)))
            << "trial " << trial << ": a voxel that is nowhere near";
      }
    }
  }
  std::cout << on_border << " voxels within the face error only\n";
}

/// A wall of 50 m across all three axes at 5 cm: 10^9 voxels in its box, at most 10^6 touched.
TEST(ForEachVoxelTouched, CostFollowsTheTouchedVoxels) {
  const VoxelGrid grid(0.05);
  const Triangle wall{Vec3(0.01, 0.02, 0.03), Vec3(50.0, 49.0, 48.0), Vec3(0.0, 3.0, 50.0)};
  std::size_t count = 0;
  ASSERT_TRUE(for_each_voxel_touched(grid, wall, [&](const Voxel&) {
    ++count;
    return true;
  }));
  const double area_m2 = 0.5 * (wall[1] - wall[0]).cross(wall[2] - wall[0]).norm();
  EXPECT_GT(static_cast<double>(count), area_m2 / (0.05 * 0.05));
  EXPECT_LT(static_cast<double>(count), 4.0 * area_m2 / (0.05 * 0.05));
}

TEST(ForEachVoxelTouched, StopsWhenToldAndRefusesWhatKeysCannotHold) {
  const VoxelGrid grid(0.1);
  const Triangle big{Vec3(0, 0, 0), Vec3(5, 0, 0), Vec3(0, 5, 0)};
  int calls = 0;
  EXPECT_FALSE(for_each_voxel_touched(grid, big, [&](const Voxel&) { return ++calls < 10; }));
  EXPECT_EQ(calls, 10);
  const Triangle far{Vec3(0, 0, 0), Vec3(5000, 0, 0), Vec3(0, 5, 0)};
  calls = 0;
  EXPECT_FALSE(for_each_voxel_touched(grid, far, [&](const Voxel&) { return ++calls < 10; }));
  EXPECT_EQ(calls, 0);
}

TEST(ForEachVoxelTouched, LeavesOutWhatIsNotWanted) {
  testing::Random random(7707);
  const VoxelGrid grid(0.25);
  for (int trial = 0; trial < 200; ++trial) {
    const Mesh mesh = oracle::random_mesh(random, grid.resolution_m(), 1);
    std::set<Voxel> all;
    std::set<Voxel> odd;
    const auto is_odd = [](const Voxel& v) { return (v[0] + v[1] + v[2]) % 2 != 0; };
    for_each_voxel_touched(grid, mesh.triangle(0),
                           [&](const Voxel& voxel) { return all.insert(voxel).second; });
    for_each_voxel_touched(grid, mesh.triangle(0), is_odd,
                           [&](const Voxel& voxel) { return odd.insert(voxel).second; });
    std::erase_if(all, [&](const Voxel& voxel) { return !is_odd(voxel); });
    ASSERT_EQ(odd, all);
  }
}

}  // namespace
}  // namespace camway::scene
