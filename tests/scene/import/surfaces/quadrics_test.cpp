// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/quadrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "tests/support/random.h"

namespace camway::scene::surfaces {
namespace {

constexpr std::uint64_t kQuadricSeed = 4401;

using geometry::Vec3;

Vec3 vec(const Point& p) { return {p[0], p[1], p[2]}; }

double area_of(const FacetedSurface& surface) {
  double area = 0.0;
  for (const auto& t : surface.triangles) {
    const Vec3 a = vec(surface.points[t[0]]);
    area += 0.5 * (vec(surface.points[t[1]]) - a).cross(vec(surface.points[t[2]]) - a).norm();
  }
  return area;
}

/// Volume inside; positive if triangles turn counter-clockwise as seen from outside.
double volume_of(const FacetedSurface& surface) {
  double volume = 0.0;
  for (const auto& t : surface.triangles) {
    volume +=
        vec(surface.points[t[0]]).dot(vec(surface.points[t[1]]).cross(vec(surface.points[t[2]]))) /
        6.0;
  }
  return volume;
}

/// Whether each edge has a triangle on either side, in opposite directions.
bool is_closed(const FacetedSurface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 0; });
}

/// The greatest distance of random points of the triangles from a surface.
template <class Distance>
double farthest(const FacetedSurface& surface, const Distance& distance) {
  testing::Random random(kQuadricSeed);
  double largest = 0.0;
  for (const auto& t : surface.triangles) {
    for (int i = 0; i < 20; ++i) {
      const double u = random.uniform(0.0, 1.0);
      const double v = random.uniform(0.0, 1.0 - u);
      const Vec3 point = (1.0 - u - v) * vec(surface.points[t[0]]) + u * vec(surface.points[t[1]]) +
                         v * vec(surface.points[t[2]]);
      largest = std::max(largest, distance(point));
    }
  }
  return largest;
}

TEST(Quadrics, SphereIsClosedAndWithinItsError) {
  for (const double radius : {1.0, 0.25, 3e5}) {
    const FacetedSurface made = sphere(radius);
    EXPECT_TRUE(is_closed(made));
    EXPECT_LE(made.error, kRelativeTolerance * radius);
    const double off = farthest(made, [&](const Vec3& p) { return std::abs(radius - p.norm()); });
    EXPECT_LE(off, made.error);
    EXPECT_GT(off, 0.5 * made.error);
    const double kBall = 4.0 / 3.0 * std::numbers::pi;
    EXPECT_LT(volume_of(made), kBall * std::pow(radius, 3));
    EXPECT_GT(volume_of(made), kBall * std::pow(radius - made.error, 3));
    for (const Point& p : made.points) EXPECT_NEAR(vec(p).norm(), radius, 1e-15 * 4 * radius);
  }
}

TEST(Quadrics, CylinderIsClosedAndWithinItsError) {
  const double radius = 2.0;
  const double height = 5.0;
  const FacetedSurface made = cylinder(radius, height, {});
  EXPECT_TRUE(is_closed(made));
  EXPECT_LE(made.error, kRelativeTolerance * radius);
  EXPECT_GT(volume_of(made), std::numbers::pi * std::pow(radius - made.error, 2) * height);
  EXPECT_LT(volume_of(made), std::numbers::pi * radius * radius * height);
  const FacetedSurface side = cylinder(radius, height, {true, false, false});
  const double off =
      farthest(side, [&](const Vec3& p) { return std::abs(radius - std::hypot(p.x(), p.z())); });
  EXPECT_LE(off, made.error);
  EXPECT_GT(off, 0.5 * made.error);
  EXPECT_NEAR(area_of(side), 2.0 * std::numbers::pi * radius * height, 2e-3 * area_of(side));
}

TEST(Quadrics, PartsOfACylinderAreWhereTheyBelong) {
  for (const auto& p : cylinder(1.0, 4.0, {false, true, false}).triangles) {
    for (const std::uint32_t corner : p) {
      EXPECT_EQ(cylinder(1.0, 4.0, {}).points[corner][1], 2.0);
    }
  }
  EXPECT_TRUE(cylinder(1.0, 4.0, {false, false, false}).triangles.empty());
  EXPECT_NEAR(area_of(cylinder(1.0, 4.0, {false, false, true})), std::numbers::pi, 5e-3);
}

TEST(Quadrics, ConeIsClosedAndWithinItsError) {
  const FacetedSurface made = cone(2.0, 3.0, {});
  EXPECT_TRUE(is_closed(made));
  EXPECT_LE(made.error, kRelativeTolerance * 2.0);
  EXPECT_GT(volume_of(made), std::numbers::pi * std::pow(2.0 - made.error, 2));
  EXPECT_LT(volume_of(made), std::numbers::pi * 4.0);
  // The distance from the true cone, across its side.
  const double slope = 3.0 / std::hypot(2.0, 3.0);
  const double off = farthest(cone(2.0, 3.0, {true, false, false}), [&](const Vec3& p) {
    return std::abs(2.0 * (1.5 - p.y()) / 3.0 - std::hypot(p.x(), p.z())) * slope;
  });
  EXPECT_LE(off, made.error);
}

}  // namespace
}  // namespace camway::scene::surfaces
