// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/nurbs_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/scene/import/surfaces/triangle_distance.h"
#include "tests/support/random.h"

namespace camway::scene::surfaces {
namespace {

constexpr std::uint64_t kNurbsSeed = 9021;

using camway::testing::distance_to_triangle;
using geometry::Vec3;

/// The basis function of Cox and de Boor, by its recursion: an oracle that shares no code.
double basis(const std::vector<double>& knots, std::size_t i, std::size_t degree, double t) {
  if (degree == 0) return knots[i] <= t && t < knots[i + 1] ? 1.0 : 0.0;
  double sum = 0.0;
  if (const double span = knots[i + degree] - knots[i]; span > 0.0) {
    sum += (t - knots[i]) / span * basis(knots, i, degree - 1, t);
  }
  if (const double span = knots[i + degree + 1] - knots[i + 1]; span > 0.0) {
    sum += (knots[i + degree + 1] - t) / span * basis(knots, i + 1, degree - 1, t);
  }
  return sum;
}

Vec3 point_of(const NurbsSurface& surface, double u, double v) {
  const std::size_t p = surface.u_knots.size() - surface.u_points - 1;
  const std::size_t q = surface.v_knots.size() - surface.v_points - 1;
  Vec3 sum = Vec3::Zero();
  double weight = 0.0;
  for (std::size_t j = 0; j < surface.v_points; ++j) {
    for (std::size_t i = 0; i < surface.u_points; ++i) {
      const double b = basis(surface.u_knots, i, p, u) * basis(surface.v_knots, j, q, v);
      const WeightedPoint& point = surface.points[j * surface.u_points + i];
      sum += b * Vec3(point[0], point[1], point[2]);
      weight += b * point[3];
    }
  }
  return sum / weight;
}

/// Longest edge of the triangles, which is their reach from a corner.
double longest_edge(const FacetedSurface& facets) {
  double longest = 0.0;
  for (const auto& t : facets.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& a = facets.points[t[k]];
      const Point& b = facets.points[t[(k + 1) % 3]];
      longest = std::max(longest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    }
  }
  return longest;
}

double distance_to(const FacetedSurface& facets, double reach, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  const auto at = [&](std::uint32_t i) {
    return Vec3(facets.points[i][0], facets.points[i][1], facets.points[i][2]);
  };
  const Point eye = {p.x(), p.y(), p.z()};
  for (const auto& t : facets.triangles) {
    const Point& a = facets.points[t[0]];
    if (std::hypot(a[0] - eye[0], a[1] - eye[1], a[2] - eye[2]) > least + reach) continue;
    least = std::min(least, distance_to_triangle(p, at(t[0]), at(t[1]), at(t[2])));
  }
  return least;
}

std::vector<double> random_knots(testing::Random& random, std::size_t points, std::size_t degree) {
  std::vector<double> knots(points + degree + 1);
  double t = random.uniform(-2.0, 2.0);
  for (double& knot : knots) {
    knot = t;
    if (random.chance(0.8)) t += random.uniform(0.1, 1.0);
  }
  if (random.chance(0.5)) {  // clamped at both ends
    for (std::size_t i = 0; i <= degree; ++i) {
      knots[i] = knots[degree];
      knots[points + i] = knots[points];
    }
  }
  return knots;
}

NurbsSurface random_surface(testing::Random& random, bool is_rational) {
  NurbsSurface surface;
  const auto p = static_cast<std::size_t>(random.integer(1, 4));
  const auto q = static_cast<std::size_t>(random.integer(1, 3));
  surface.u_points = p + 1 + static_cast<std::size_t>(random.integer(0, 2));
  surface.v_points = q + 1 + static_cast<std::size_t>(random.integer(0, 2));
  surface.u_knots = random_knots(random, surface.u_points, p);
  surface.v_knots = random_knots(random, surface.v_points, q);
  for (std::size_t j = 0; j < surface.v_points; ++j) {
    for (std::size_t i = 0; i < surface.u_points; ++i) {
      const double w = is_rational ? random.log_uniform(0.3, 3.0) : 1.0;
      const Vec3 at =
          Vec3(static_cast<double>(i), static_cast<double>(j), 0.0) + random.in_cube(0.7);
      surface.points.push_back({w * at.x(), w * at.y(), w * at.z(), w});
    }
  }
  return surface;
}

TEST(NurbsSurface, IsWithinItsErrorOfTheTrueSurface) {
  testing::Random random(kNurbsSeed);
  int made = 0;
  double closest = 0.0;
  for (int trial = 0; trial < 24; ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    const NurbsSurface surface = random_surface(random, trial % 2 == 1);
    constexpr double kTolerance = 0.1;
    const base::Result<FacetedSurface> facets = facets_of(surface, kTolerance);
    if (!facets) {  // knots without a span
      EXPECT_EQ(facets.error, "has knots without a span");
      continue;
    }
    ++made;
    EXPECT_LE(facets->error, kTolerance);
    const std::size_t p = surface.u_knots.size() - surface.u_points - 1;
    const std::size_t q = surface.v_knots.size() - surface.v_points - 1;
    const double reach = longest_edge(*facets);
    for (int i = 0; i < 8; ++i) {
      const double u = random.uniform(surface.u_knots[p], surface.u_knots[surface.u_points]);
      const double v = random.uniform(surface.v_knots[q], surface.v_knots[surface.v_points]);
      const double off = distance_to(*facets, reach, point_of(surface, u, v));
      ASSERT_LE(off, facets->error + 1e-12) << u << " " << v;
      closest = std::max(closest, off / facets->error);
    }
  }
  EXPECT_GT(made, 15);
  EXPECT_GT(closest, 0.2) << "the bound is of no use";
}

/// A quarter of a cylinder of radius 1, which only a rational surface is.
NurbsSurface quarter_cylinder() {
  const double w = std::sqrt(0.5);
  NurbsSurface surface{3, 2, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, {}};
  for (const double z : {0.0, 2.0}) {
    surface.points.push_back({1, 0, z, 1});
    surface.points.push_back({w, w, w * z, w});
    surface.points.push_back({0, 1, z, 1});
  }
  return surface;
}

TEST(NurbsSurface, ARationalArcIsACircle) {
  const base::Result<FacetedSurface> facets = facets_of(quarter_cylinder(), 1e-4);
  ASSERT_TRUE(facets) << facets.error;
  double area = 0.0;
  for (const auto& t : facets->triangles) {
    const auto at = [&](std::size_t k) {
      const Point& p = facets->points[t[k]];
      EXPECT_NEAR(std::hypot(p[0], p[1]), 1.0, 1e-14);
      return Vec3(p[0], p[1], p[2]);
    };
    area += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  EXPECT_NEAR(area, M_PI, 2e-4 * M_PI);
  EXPECT_LT(facets->triangles.size(), 300U) << "it is divided along the axis, where it is straight";
}

TEST(NurbsSurface, APlaneTakesTwoTriangles) {
  NurbsSurface surface{4, 4, {0, 0, 0, 0, 1, 1, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}, {}};
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) surface.points.push_back({i / 3.0, j / 3.0, 0.5, 1.0});
  }
  const base::Result<FacetedSurface> facets = facets_of(surface, 1e-9);
  ASSERT_TRUE(facets) << facets.error;
  EXPECT_EQ(facets->triangles.size(), 2U);
  EXPECT_LE(facets->error, 1e-9);
}

TEST(NurbsSurface, SaysWhatErrorItReachedIfTheToleranceIsTooSmall) {
  const base::Result<FacetedSurface> facets = facets_of(quarter_cylinder(), 0.0);
  ASSERT_TRUE(facets) << facets.error;
  EXPECT_GT(facets->error, 0.0);
  EXPECT_LT(facets->error, 1e-6);
  EXPECT_LE(facets->triangles.size(), 2 * kMostCells);
}

TEST(NurbsSurface, RefusesNumbersThatDoNotFit) {
  const NurbsSurface sound = quarter_cylinder();
  const auto fault = [&](auto change) {
    NurbsSurface surface = sound;
    change(surface);
    return facets_of(surface, 1e-3).error;
  };
  EXPECT_EQ(fault([](NurbsSurface& s) { s.points.pop_back(); }),
            "has another number of control points than it says");
  EXPECT_EQ(fault([](NurbsSurface& s) { s.u_points = std::size_t{1} << 63U; }),
            "has another number of control points than it says");
  EXPECT_EQ(fault([](NurbsSurface& s) { s.u_knots.resize(4); }), "has too few knots");
  EXPECT_EQ(fault([](NurbsSurface& s) { s.u_knots.resize(40, 1.0); }),
            "has too few control points for its knots");
  EXPECT_EQ(fault([](NurbsSurface& s) { s.u_knots[5] = 0.5; }), "has knots that decrease");
  EXPECT_EQ(fault([](NurbsSurface& s) { s.u_knots[5] = NAN; }), "has a knot that is no number");
  EXPECT_EQ(fault([](NurbsSurface& s) { s.points[1][3] = 0.0; }),
            "has a weight that is not positive");
  EXPECT_EQ(fault([](NurbsSurface& s) { s.points[1][0] = INFINITY; }),
            "has a control point that is no usable number");
  EXPECT_EQ(fault([](NurbsSurface& s) { s.u_knots.assign(6, 1.0); }), "has knots without a span");
}

}  // namespace
}  // namespace camway::scene::surfaces
