// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/shape_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "daemon/scene/index/scene_index.h"
#include "tests/geometry/random_triangles.h"

namespace camway::scene {
namespace {

using geometry::RandomTriangles;
using geometry::Triangle;
using geometry::Vec3;
using ::testing::HasSubstr;
using Real = long double;
using RealVec3 = Eigen::Matrix<Real, 3, 1>;

constexpr double kEndless_m = std::numeric_limits<double>::infinity();
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Expects that each edge belongs to two triangles with opposite directions: the mesh is closed,
/// and all triangles face the same side.
void expect_closed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      edges[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, sum] : edges) EXPECT_EQ(sum, 0);
}

/// Returns six times the enclosed volume, which is positive if the triangles face outwards.
Real volume(const Mesh& mesh) {
  Real sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    sum += t[0].cast<Real>().dot(t[1].cast<Real>().cross(t[2].cast<Real>()));
  }
  return sum / 6;
}

Real plane_distance(const Triangle& t) {
  const RealVec3 a = t[0].cast<Real>();
  const RealVec3 normal = (t[1].cast<Real>() - a).cross(t[2].cast<Real>() - a).normalized();
  return std::abs(normal.dot(a));
}

TEST(BoxMesh, IsTheBox) {
  const auto box = box_mesh(Vec3(1, 2, 4));
  ASSERT_TRUE(box) << box.error;
  expect_closed(*box);
  EXPECT_EQ(volume(*box), 8);
  EXPECT_EQ(box->bounds().max(), Vec3(0.5, 1, 2));
  EXPECT_EQ(box->bounds().min(), Vec3(-0.5, -1, -2));
  EXPECT_EQ(box->objects.front().triangle_count, 12U);
}

TEST(SphereMesh, EnclosesTheBallWithinItsChordError) {
  for (const double radius_m : {1e-3, 1.0, 7.5e5}) {
    for (const double share : {0.5, 0.1, 1e-2, 1e-3}) {
      const double chord_m = share * radius_m;
      const auto sphere = sphere_mesh(radius_m, chord_m);
      ASSERT_TRUE(sphere) << sphere.error;
      expect_closed(*sphere);
      EXPECT_GT(volume(*sphere), 0);
      for (std::size_t i = 0; i < sphere->triangles.size(); ++i) {
        ASSERT_GE(plane_distance(sphere->triangle(i)), static_cast<Real>(radius_m));
      }
      for (const Vec3& vertex : sphere->vertices) {
        ASSERT_LE(vertex.cast<Real>().norm(), static_cast<Real>(radius_m) + chord_m);
      }
      EXPECT_LT(static_cast<double>(sphere->triangles.size()), 20.0 + 20.0 / share);
    }
  }
}

TEST(CylinderMesh, EnclosesTheCylinderWithinItsChordError) {
  for (const double share : {1.0, 0.1, 1e-3, 1e-5}) {
    const double radius_m = 0.3;
    const auto cylinder = cylinder_mesh(radius_m, 2.0, share * radius_m);
    ASSERT_TRUE(cylinder) << cylinder.error;
    expect_closed(*cylinder);
    EXPECT_GT(volume(*cylinder), 0);
    EXPECT_EQ(cylinder->bounds().max().z(), 1.0);
    EXPECT_EQ(cylinder->bounds().min().z(), -1.0);
    for (std::size_t i = 0; i < cylinder->triangles.size(); ++i) {
      Triangle t = cylinder->triangle(i);
      if (t[0].z() == t[1].z() && t[1].z() == t[2].z()) continue;  // an end
      ASSERT_GE(plane_distance(t), static_cast<Real>(radius_m));
    }
    for (const Vec3& vertex : cylinder->vertices) {
      const Real out = vertex.head<2>().cast<Real>().norm();
      ASSERT_LE(out, static_cast<Real>(radius_m) * (1 + static_cast<Real>(share)));
    }
  }
}

TEST(CloudMesh, EnclosesEveryPointAndNoMoreThanTheirCells) {
  RandomTriangles random(1401);
  for (const double cell_m : {0.1, 1.0, 3.7}) {
    std::vector<Vec3> points;
    std::set<std::array<long, 3>> cells;
    for (int i = 0; i < 200; ++i) {
      const Vec3 point =
          i % 5 == 0 ? Vec3(cell_m * random.on_grid(4)) : Vec3(cell_m * random.in_cube(4.0));
      points.push_back(point);
      cells.insert({std::lround(std::floor(point.x() / cell_m)),
                    std::lround(std::floor(point.y() / cell_m)),
                    std::lround(std::floor(point.z() / cell_m))});
    }
    const auto cloud = cloud_mesh(points, cell_m);
    ASSERT_TRUE(cloud) << cloud.error;
    EXPECT_NEAR(static_cast<double>(volume(*cloud)),
                static_cast<double>(cells.size()) * std::pow(cell_m, 3), 1e-9);
    // A ray from a point inside meets an odd number of triangles, counted by the winding number.
    const SceneIndex index = SceneIndex::build(*cloud);
    for (const auto& cell : cells) {
      const Vec3 middle = (Vec3(static_cast<double>(cell[0]), static_cast<double>(cell[1]),
                                static_cast<double>(cell[2]))
                               .array() +
                           0.5) *
                          cell_m;
      const std::array<Triangle, 1> point = {Triangle{middle, middle, middle}};
      const auto nearest = index.nearest(point, kEndless_m);
      ASSERT_GE(nearest->distance_m, 0.49 * cell_m) << "no face runs through a cell";
    }
  }
}

TEST(CloudMesh, DoesNotDependOnTheOrderOfItsPoints) {
  const std::vector<Vec3> points = {Vec3(0.5, 0.5, 0.5), Vec3(1.5, 0.5, 0.5), Vec3(9, 9, 9)};
  const std::vector<Vec3> turned(points.rbegin(), points.rend());
  EXPECT_EQ(cloud_mesh(points, 1.0)->vertices, cloud_mesh(turned, 1.0)->vertices);
  EXPECT_EQ(cloud_mesh(points, 1.0)->triangles.size(), 2U * 10 + 12);
}

TEST(ShapeMesh, RefusesWhatIsNoLengthByName) {
  for (const double bad : {0.0, -1.0, kNoNumber, kEndless_m, 1.1e9}) {
    EXPECT_THAT(box_mesh(Vec3(1, bad, 1)).error, HasSubstr("size_m"));
    EXPECT_THAT(sphere_mesh(bad, 0.1).error, HasSubstr("radius_m"));
    EXPECT_THAT(sphere_mesh(1, bad).error, HasSubstr("chord_error_m"));
    EXPECT_THAT(cylinder_mesh(bad, 1, 0.1).error, HasSubstr("radius_m"));
    EXPECT_THAT(cylinder_mesh(1, bad, 0.1).error, HasSubstr("height_m"));
    EXPECT_THAT(cylinder_mesh(1, 1, bad).error, HasSubstr("chord_error_m"));
    EXPECT_THAT(cloud_mesh(std::vector<Vec3>{Vec3::Zero()}, bad).error, HasSubstr("cell_m"));
  }
  const std::vector<Vec3> far = {Vec3::Zero(), Vec3(0, 0, 1.1e6)};
  EXPECT_THAT(cloud_mesh(far, 1.0).error, HasSubstr("points_m[1]"));
  const std::vector<Vec3> not_a_number = {Vec3(kNoNumber, 0, 0)};
  EXPECT_THAT(cloud_mesh(not_a_number, 1.0).error, HasSubstr("points_m[0]"));
  EXPECT_EQ(sphere_mesh(1.0, 1e-9).error,
            "chord_error_m: 1e-09 m needs more than 2000000 triangles");
  EXPECT_THAT(cylinder_mesh(1.0, 1.0, 1e-15).error, HasSubstr("chord_error_m"));
}

}  // namespace
}  // namespace camway::scene
