// SPDX-License-Identifier: MIT
#include "tools/view/display/display_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/support/random.h"

namespace camway::view {
namespace {

using geometry::Vec3;

constexpr std::size_t kAll = 1'000'000;

geometry::Triangle triangle_of(const DisplayMesh& display, std::size_t index) {
  geometry::Triangle corners;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const DisplayMesh::GridPoint& point =
        display.vertices.at(display.indices.at(3 * index + corner));
    corners.at(corner) = display.centre_O + display.step_m * Vec3(point[0], point[1], point[2]);
  }
  return corners;
}

/// The distance of the corners of two triangles, which may begin at any corner but have one sense.
double corner_distance_m(const geometry::Triangle& a, const geometry::Triangle& b) {
  double least_m = HUGE_VAL;
  for (std::size_t first = 0; first < 3; ++first) {
    double largest_m = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      largest_m = std::max(largest_m, (a.at(i) - b.at((i + first) % 3)).norm());
    }
    least_m = std::min(least_m, largest_m);
  }
  return least_m;
}

/// Every triangle of the mesh is shown once, within the error.
void expect_shows_all(const scene::Mesh& mesh, const DisplayMesh& display) {
  ASSERT_EQ(display.shown(), mesh.triangles.size());
  EXPECT_EQ(display.triangles, mesh.triangles.size());
  EXPECT_FALSE(display.is_simplified);
  std::vector<bool> is_taken(display.shown());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::size_t shown = 0;
    while (shown < display.shown() &&
           (is_taken[shown] ||
            corner_distance_m(mesh.triangle(i), triangle_of(display, shown)) > display.error_m)) {
      ++shown;
    }
    ASSERT_LT(shown, display.shown()) << "triangle " << i << " is not shown";
    is_taken[shown] = true;
  }
}

scene::Mesh random_mesh(testing::Random& random, double size_m, const Vec3& centre) {
  scene::Mesh mesh;
  constexpr std::uint32_t kVertices = 40;
  for (std::uint32_t i = 0; i < kVertices; ++i) {
    mesh.vertices.push_back(centre + random.in_cube(size_m));
  }
  for (std::uint32_t i = 0; i + 2 < kVertices; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

TEST(DisplayMesh, ShowsEachTriangleWithinTheErrorThatItStates) {
  testing::Random random(2101);
  for (int round = 0; round < 200; ++round) {
    const double size_m = random.log_uniform(1e-4, 1e5);
    const Vec3 centre = Vec3(1.0, -2.0, 0.5) * random.uniform(-1e4, 1e4);
    const scene::Mesh mesh = random_mesh(random, size_m, centre);
    const DisplayMesh display = display_mesh(mesh, kAll);
    expect_shows_all(mesh, display);
    // Up to ten kilometres, and finer for small objects.
    if (size_m < 1e4) {
      EXPECT_LE(display.error_m, 1.01 * kDisplayError_m + 0x1p-22 * size_m);
    }
    EXPECT_LE(display.error_m, size_m / 4000.0);
    if (HasFailure()) FAIL() << "size " << size_m << " m at " << centre.transpose();
  }
}

TEST(DisplayMesh, LeavesOutWhatIsBelowTheGrid) {
  scene::Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {1e-6, 0, 0}, {0, 1e-6, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}, {0, 1, 3}, {2, 2, 1}};
  const DisplayMesh display = display_mesh(mesh, kAll);
  EXPECT_EQ(display.shown(), 1);
  EXPECT_EQ(display.triangles, 4);
  EXPECT_FALSE(display.is_simplified);
  EXPECT_EQ(display.vertices.size(), 3);
}

TEST(DisplayMesh, OfNothingIsNothing) {
  EXPECT_EQ(display_mesh({}, kAll).shown(), 0);
  scene::Mesh point;
  point.vertices = {{1, 2, 3}, {1, 2, 3}};
  point.triangles = {{0, 1, 0}, {1, 1, 1}};
  const DisplayMesh display = display_mesh(point, kAll);
  EXPECT_EQ(display.shown(), 0);
  EXPECT_EQ(display.triangles, 2);
}

TEST(DisplayMesh, VerticesWithoutATriangleMayBeAnywhere) {
  scene::Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1e9, -1e9, 1e9}};
  mesh.triangles = {{0, 1, 2}};
  expect_shows_all(mesh, display_mesh(mesh, kAll));
}

TEST(DisplayMesh, IsTheSameForTheSameMesh) {
  testing::Random random(2102);
  const scene::Mesh mesh = random_mesh(random, 3.0, Vec3::Zero());
  const DisplayMesh a = display_mesh(mesh, 20);
  const DisplayMesh b = display_mesh(mesh, 20);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.indices, b.indices);
  EXPECT_EQ(a.error_m, b.error_m);
}

TEST(DisplayMesh, ABallWithFewerTrianglesIsStillThatBall) {
  constexpr double kRadius_m = 2.0;
  const base::Result<scene::Mesh> ball = scene::sphere_mesh(kRadius_m, 1e-4);
  ASSERT_TRUE(ball) << ball.error;
  constexpr std::size_t kMost = 2000;
  ASSERT_GT(ball->triangles.size(), 10 * kMost);
  const DisplayMesh display = display_mesh(*ball, kMost);
  EXPECT_TRUE(display.is_simplified);
  EXPECT_LE(display.shown(), kMost + kMost / 4);
  EXPECT_GE(display.shown(), kMost / 2);
  EXPECT_EQ(display.triangles, ball->triangles.size());
  EXPECT_LT(display.error_m, 0.02);
  double area_m2 = 0.0;
  for (std::size_t i = 0; i < display.shown(); ++i) {
    const geometry::Triangle corners = triangle_of(display, i);
    const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    // The simplifier's error is an estimate; on a sphere it is off by less than a factor of 3.
    EXPECT_NEAR(middle.norm(), kRadius_m, 3.0 * display.error_m);
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    EXPECT_GT(normal.dot(middle), 0.0);
    area_m2 += normal.norm() / 2.0;
  }
  EXPECT_NEAR(area_m2, 4.0 * std::numbers::pi * kRadius_m * kRadius_m, 0.5);
}

TEST(DisplayMesh, TrianglesThatShareNothingAreClustered) {
  testing::Random random(2103);
  scene::Mesh soup;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const Vec3 at = random.in_cube(5.0);
    soup.vertices.insert(soup.vertices.end(), {at, at + Vec3(0.3, 0, 0), at + Vec3(0, 0.3, 0.1)});
    soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const DisplayMesh display = display_mesh(soup, 300);
  EXPECT_TRUE(display.is_simplified);
  EXPECT_LE(display.shown(), 375);
  EXPECT_GT(display.shown(), 30);
  EXPECT_GT(display.error_m, 0.01);
  EXPECT_LT(display.error_m, 10.0);
}

}  // namespace
}  // namespace camway::view
