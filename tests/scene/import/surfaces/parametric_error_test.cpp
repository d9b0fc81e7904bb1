// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/parametric_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

#include "daemon/scene/import/surfaces/knot_axis.h"
#include "tests/scene/import/surfaces/triangle_distance.h"
#include "tests/support/random.h"

namespace camway::scene::surfaces {
namespace {

constexpr std::uint64_t kParametricSeed = 60211;

using camway::testing::NearTriangles;
using camway::testing::Random;
using geometry::Vec3;

/// A cylinder of radius 1 about z, all round in u by four arcs, from v = 0 to 1. `u` of a point at
/// `angle` comes from the arc's own parameter.
ParametricSurface whole_cylinder(bool is_periodic) {
  ParametricSurface result;
  NurbsSurface& s = result.surface;
  s = {9, 2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, {0, 0, 1, 1}, {}};
  for (const double z : {0.0, 1.0}) {
    for (int i = 0; i < 9; ++i) {
      const double angle = i * std::numbers::pi / 4.0;
      const double w = i % 2 == 0 ? 1.0 : std::sqrt(0.5);
      const double r = 1.0 / w;
      s.points.push_back({w * r * std::cos(angle), w * r * std::sin(angle), w * z, w});
    }
  }
  if (is_periodic) result.periods = {4.0, 0.0};
  return result;
}

/// A point of the cylinder, by tan of half the angle: an oracle that shares no code.
Vec3 on_cylinder(const Parameters& at) {
  const double quarter = std::floor(at[0]);
  const double t = at[0] - quarter;
  const double c = std::sqrt(0.5);
  const double w = (1 - t) * (1 - t) + 2 * c * t * (1 - t) + t * t;
  const double x = ((1 - t) * (1 - t) + 2 * c * t * (1 - t)) / w;
  const double y = (2 * c * t * (1 - t) + t * t) / w;
  const double turn = quarter * std::numbers::pi / 2.0;
  return {x * std::cos(turn) - y * std::sin(turn), x * std::sin(turn) + y * std::cos(turn), at[1]};
}

ParametricSurface flat() {
  ParametricSurface result;
  result.surface = {
      2, 2, {0, 0, 1, 1}, {0, 0, 1, 1}, {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 0, 1}}};
  return result;
}
Vec3 on_flat(const Parameters& at) { return {at[0], at[1], 0.0}; }

/// A rectangle of parameters, as a grid whose inner nodes are moved about, and which may be beside
/// the surface by `off`.
ParametricMesh grid_mesh(Random& random, const Parameters& low, const Parameters& high, int columns,
                         int rows, double off) {
  ParametricMesh mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      Parameters at = {low[0] + (high[0] - low[0]) * i / columns,
                       low[1] + (high[1] - low[1]) * j / rows};
      if (i > 0 && i < columns) at[0] += random.uniform(-0.3, 0.3) * (high[0] - low[0]) / columns;
      if (j > 0 && j < rows) at[1] += random.uniform(-0.3, 0.3) * (high[1] - low[1]) / rows;
      mesh.parameters.push_back(at);
      const Vec3 p = on_cylinder(at) + random.in_cube(off);
      mesh.points.push_back({p.x(), p.y(), p.z()});
    }
  }
  const auto node = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      mesh.triangles.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1)});
      mesh.triangles.push_back({node(i, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  }
  for (int i = 0; i < columns; ++i) {
    mesh.boundary.push_back({{node(i, 0), node(i + 1, 0)}, {}});
    mesh.boundary.push_back({{node(i + 1, rows), node(i, rows)}, {}});
  }
  for (int j = 0; j < rows; ++j) {
    mesh.boundary.push_back({{node(0, j + 1), node(0, j)}, {}});
    mesh.boundary.push_back({{node(columns, j), node(columns, j + 1)}, {}});
  }
  return mesh;
}

Vec3 as_vector(const Point& p) { return {p[0], p[1], p[2]}; }

/// Largest distance of triangles from the cylinder, by random points of each.
double farthest_of_cylinder(Random& random, const ParametricMesh& mesh) {
  double farthest = 0.0;
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 30; ++i) {
      const double a = random.uniform(0.0, 1.0);
      const double b = random.uniform(0.0, 1.0 - a);
      const Vec3 p = a * as_vector(mesh.points[t[0]]) + b * as_vector(mesh.points[t[1]]) +
                     (1 - a - b) * as_vector(mesh.points[t[2]]);
      farthest = std::max(farthest, std::abs(std::hypot(p.x(), p.y()) - 1.0));
    }
  }
  return farthest;
}

TEST(ParametricError, BoundsTrianglesThatCrossKnots) {
  Random random(kParametricSeed);
  const ParametricSurface cylinder = whole_cylinder(false);
  for (const int columns : {3, 7, 16, 40}) {
    SCOPED_TRACE(columns);
    const ParametricMesh mesh = grid_mesh(random, {0.3, 0.1}, {3.7, 0.8}, columns, 3, 0.0);
    const base::Result<double> error = error_of(cylinder, mesh);
    ASSERT_TRUE(error) << error.error;
    const double farthest = farthest_of_cylinder(random, mesh);
    EXPECT_LE(farthest, *error);
    EXPECT_LE(*error, 6.0 * farthest) << "the bound is of no use";
  }
}

TEST(ParametricError, APeriodicSurfaceGoesOn) {
  Random random(kParametricSeed);
  const ParametricMesh mesh = grid_mesh(random, {3.1, 0.0}, {6.3, 1.0}, 24, 2, 0.0);
  const base::Result<double> error = error_of(whole_cylinder(true), mesh);
  ASSERT_TRUE(error) << error.error;
  EXPECT_GE(*error, farthest_of_cylinder(random, mesh));
  EXPECT_LE(*error, 0.02);
  const base::Result<double> without = error_of(whole_cylinder(false), mesh);
  EXPECT_TRUE(!without || *without > 0.1) << "beyond the last knot the polynomial is no cylinder";
}

TEST(ParametricError, NodesBesideTheSurfaceCount) {
  Random random(kParametricSeed);
  const ParametricMesh exact = grid_mesh(random, {0.0, 0.0}, {2.0, 1.0}, 60, 2, 0.0);
  ParametricMesh moved = exact;
  moved.points[70][0] += 0.05;
  const double before = *error_of(whole_cylinder(false), exact);
  const double after = *error_of(whole_cylinder(false), moved);
  EXPECT_LT(before, 0.002);
  EXPECT_GE(after, 0.05);
  EXPECT_LE(after, 0.05 + 4.0 * before);
}

TEST(ParametricError, ThinTrianglesDoNoHarm) {
  // Three nodes along a line that is nearly straight in the parameters.
  ParametricMesh mesh;
  for (const Parameters& at :
       {Parameters{0.1, 0.1}, Parameters{0.3, 0.3 - 1e-9}, Parameters{0.5, 0.5}}) {
    mesh.parameters.push_back(at);
    const Vec3 p = on_cylinder(at);
    mesh.points.push_back({p.x(), p.y(), p.z()});
  }
  mesh.triangles = {{0, 1, 2}};
  mesh.boundary = {{{0, 1}, {}}, {{1, 2}, {}}, {{2, 0}, {}}};
  const base::Result<double> error = error_of(whole_cylinder(false), mesh);
  ASSERT_TRUE(error) << error.error;
  EXPECT_LE(*error, 0.1);
}

/// A disc in the middle of the cylinder's parameters, with its true outline as the trim curve: a
/// fan within chords.
ParametricMesh disc(int sides, double radius, const std::function<Vec3(const Parameters&)>& on) {
  ParametricMesh mesh;
  const Parameters centre = {0.5, 0.5};
  const auto add = [&](const Parameters& at) {
    mesh.parameters.push_back(at);
    const Vec3 p = on(at);
    mesh.points.push_back({p.x(), p.y(), p.z()});
  };
  const auto on_rim = [&](double angle, double r) {
    return Parameters{centre[0] + r * std::cos(angle), centre[1] + r * std::sin(angle)};
  };
  add(centre);
  const double step = 2.0 * std::numbers::pi / sides;
  for (int i = 0; i < sides; ++i) add(on_rim(i * step, radius));
  for (int i = 0; i < sides; ++i) {
    const auto a = static_cast<std::uint32_t>(1 + i);
    const auto b = static_cast<std::uint32_t>(1 + (i + 1) % sides);
    mesh.triangles.push_back({0, a, b});
    mesh.boundary.push_back({{a, b}, {on_rim((i + 0.5) * step, radius / std::cos(0.5 * step))}});
  }
  return mesh;
}

constexpr double kDiscRadius = 0.3;

/// Largest distance of a disc's outer part from its triangles.
double farthest_of_disc(Random& random, const ParametricMesh& mesh, double reach,
                        const std::function<Vec3(const Parameters&)>& on) {
  NearTriangles near(reach);
  for (const auto& t : mesh.triangles) {
    near.add(as_vector(mesh.points[t[0]]), as_vector(mesh.points[t[1]]),
             as_vector(mesh.points[t[2]]));
  }
  double farthest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double r = kDiscRadius * std::sqrt(random.uniform(0.8, 1.0));
    farthest = std::max(farthest,
                        near.distance(on({0.5 + r * std::cos(angle), 0.5 + r * std::sin(angle)})));
  }
  return farthest;
}

TEST(ParametricError, TheSagOfTrimCurvesCounts) {
  Random random(kParametricSeed);
  for (const int sides : {6, 12, 48}) {
    SCOPED_TRACE(sides);
    const ParametricMesh mesh = disc(sides, kDiscRadius, on_flat);
    const base::Result<double> error = error_of(flat(), mesh);
    ASSERT_TRUE(error) << error.error;
    const double farthest = farthest_of_disc(random, mesh, 2.0 * *error, on_flat);
    EXPECT_LE(farthest, *error);
    EXPECT_LE(*error, 4.0 * farthest) << "the bound is of no use";
  }
}

TEST(ParametricError, TheSagOfTrimCurvesCountsOnACurvedSurfaceToo) {
  Random random(kParametricSeed);
  for (const int sides : {6, 24}) {
    SCOPED_TRACE(sides);
    const ParametricMesh mesh = disc(sides, kDiscRadius, on_cylinder);
    const base::Result<double> error = error_of(whole_cylinder(false), mesh);
    ASSERT_TRUE(error) << error.error;
    EXPECT_LE(farthest_of_disc(random, mesh, 2.0 * *error, on_cylinder), *error);
  }
}

TEST(ParametricError, TrianglesThatAreNotTheRegionAreRefused) {
  Random random(kParametricSeed);
  const ParametricSurface cylinder = whole_cylinder(false);
  const ParametricMesh sound = grid_mesh(random, {0.1, 0.1}, {0.9, 0.9}, 4, 4, 0.0);
  ASSERT_TRUE(error_of(cylinder, sound));
  const auto fault = [&](auto change) {
    ParametricMesh mesh = sound;
    change(mesh);
    return error_of(cylinder, mesh).error;
  };
  const std::string outline = "has triangles whose outline is not its boundary";
  EXPECT_EQ(fault([](ParametricMesh& m) { m.triangles.pop_back(); }), outline);
  EXPECT_EQ(fault([](ParametricMesh& m) { m.triangles.push_back(m.triangles[3]); }), outline);
  EXPECT_EQ(fault([](ParametricMesh& m) { m.boundary.pop_back(); }), outline);
  EXPECT_EQ(
      fault([](ParametricMesh& m) { std::swap(m.boundary[0].nodes[0], m.boundary[0].nodes[1]); }),
      outline);
  EXPECT_EQ(fault([](ParametricMesh& m) { m.triangles.clear(); }), outline);
  EXPECT_EQ(fault([](ParametricMesh& m) {
              m.parameters[6] = {0.9, 0.9};
            }),
            "has triangles that turn over");
  // A hole that was meshed over: its chords have triangles on both sides.
  EXPECT_EQ(
      fault([](ParametricMesh& m) {
        for (const auto& side : {std::array<std::uint32_t, 2>{6, 7}, {7, 12}, {12, 11}, {11, 6}}) {
          m.boundary.push_back({{side[1], side[0]}, {}});
        }
      }),
      outline);
  EXPECT_EQ(fault([](ParametricMesh& m) { m.points[3][1] = NAN; }),
            "has a weight or a number that is of no use");
}

TEST(ParametricError, AFlatSurfaceHasNoError) {
  Random random(kParametricSeed);
  ParametricMesh mesh = grid_mesh(random, {-2.0, 0.0}, {3.0, 1.0}, 5, 5, 0.0);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    mesh.points[i] = {mesh.parameters[i][0], mesh.parameters[i][1], 0.0};
  }
  EXPECT_LE(*error_of(flat(), mesh), 1e-12);
}

TEST(KnotAxis, TheHullOfAPieceIsNearThePiece) {
  // A quarter of a circle, in one piece and in ten.
  const double w = std::sqrt(0.5);
  const PlaneCurve arc{{{1, 0, 0, 1}, {w, w, 0, w}, {0, 1, 0, 1}}, {0, 0, 0, 1, 1, 1}, 0.0};
  for (const int pieces : {1, 10}) {
    for (int i = 0; i < pieces; ++i) {
      const double low = static_cast<double>(i) / pieces;
      const double high = static_cast<double>(i + 1) / pieces;
      const auto hull = hull_of(arc, low, high);
      ASSERT_EQ(hull.size(), 3U);
      EXPECT_NEAR(std::hypot(hull[0][0], hull[0][1]), 1.0, 1e-15);
      EXPECT_NEAR(std::hypot(hull[2][0], hull[2][1]), 1.0, 1e-15);
      EXPECT_GE(std::hypot(hull[1][0], hull[1][1]), 1.0);
      EXPECT_LE(std::hypot(hull[1][0], hull[1][1]), 1.0 + 0.42 / (pieces * pieces));
    }
  }
}

}  // namespace
}  // namespace camway::scene::surfaces
