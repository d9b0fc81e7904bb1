// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/edge_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "daemon/scene/import/surfaces/surface_points.h"
#include "tests/support/random.h"

namespace camway::scene::surfaces {
namespace {

constexpr std::uint64_t kRefinementSeed = 7301;
constexpr std::size_t kMany = 100'000;
constexpr double kTolerance = 1e-3;
constexpr std::uint32_t kSharedEdge = 0;
constexpr double kBeside = 1e-9;

using camway::testing::Random;

/// A bicubic patch with weights, over [0, 1] x [0, 1], beside x = `first`.
ParametricSurface patch(Random& random, double first, double bumps) {
  ParametricSurface result;
  NurbsSurface& s = result.surface;
  s = {4, 4, {0, 0, 0, 0, 1, 1, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}, {}};
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const double w = random.uniform(0.5, 2.0);
      const double z = bumps * random.uniform(-1.0, 1.0);
      s.points.push_back({w * (first + i / 3.0), w * j / 3.0, w * z, w});
    }
  }
  return result;
}

PlaneCurve line(const Parameters& a, const Parameters& b) {
  return {{{a[0], a[1], 0, 1}, {b[0], b[1], 0, 1}}, {0, 0, 1, 1}, 0.0};
}

/// The whole patch as two triangles. Edges are numbered from `edges`, the sides at u = 1, v = 1, u
/// = 0, v = 0; their parameters are u or v.
RefinableFace square(const ParametricSurface& surface, const std::array<std::uint32_t, 4>& edges) {
  RefinableFace face;
  face.surface = surface;
  face.mesh.parameters = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const Parameters& at : face.mesh.parameters) {
    face.mesh.points.push_back(SurfacePoints(surface).point(at));
  }
  face.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  face.curves = {line({1, 0}, {1, 1}), line({0, 1}, {1, 1}), line({0, 0}, {0, 1}),
                 line({0, 0}, {1, 0})};
  const std::array<std::array<std::uint32_t, 2>, 4> sides = {{{1, 2}, {2, 3}, {3, 0}, {0, 1}}};
  for (std::size_t k = 0; k < 4; ++k) {
    const bool is_reversed = k == 1 || k == 2;
    face.mesh.boundary.push_back({sides[k], {}});
    face.sources.push_back(
        {EdgePiece{edges[k], 1}, k, is_reversed ? 1.0 : 0.0, is_reversed ? 0.0 : 1.0});
  }
  return face;
}

/// Two patches that share the edge at u = 1 of the first and u = 0 of the second.
struct Pair {
  RefinableFace a;
  RefinableFace b;

  Pair(Random& random, double bumps) {
    const ParametricSurface left = patch(random, 0.0, bumps);
    ParametricSurface right = patch(random, 1.0, bumps);
    for (std::size_t j = 0; j < 4; ++j)
      right.surface.points[4 * j] = left.surface.points[4 * j + 3];
    a = square(left, {kSharedEdge, 1, 2, 3});
    b = square(right, {4, 5, kSharedEdge, 6});
    // The faces have the same nodes, to the bit.
    b.mesh.points[0] = a.mesh.points[1];
    b.mesh.points[3] = a.mesh.points[2];
  }

  /// A little beside the faces, as edges of files are.
  [[nodiscard]] Point edge_point(std::uint32_t edge, double t) const {
    const std::array<Parameters, 7> at = {{{1, t}, {t, 1}, {0, t}, {t, 0}, {1, t}, {t, 1}, {t, 0}}};
    Point point = SurfacePoints(edge < 4 ? a.surface : b.surface).point(at[edge]);
    point[2] += kBeside;
    return point;
  }

  void expect_nodes_on_edges(const RefinableFace& face) const {
    for (std::size_t i = 0; i < face.sources.size(); ++i) {
      const BoundarySource& source = face.sources[i];
      if (source.from == 0.0 || source.from == 1.0) continue;  // a node of the first triangles
      EXPECT_EQ(face.mesh.points[face.mesh.boundary[i].nodes[0]],
                edge_point(source.piece->edge, source.from));
    }
  }
  void refine(double tolerance, std::size_t most = kMany) {
    const std::array<RefinableFace*, 2> faces = {&a, &b};
    refine_sides(
        faces, [this](std::uint32_t edge, double t) { return edge_point(edge, t); }, tolerance,
        most);
  }
};

double area(const ParametricMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Parameters& a = mesh.parameters[t[0]];
  const Parameters& b = mesh.parameters[t[1]];
  const Parameters& c = mesh.parameters[t[2]];
  return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
}

double area(const ParametricMesh& mesh) {
  double sum = 0.0;
  for (const auto& triangle : mesh.triangles) sum += area(mesh, triangle);
  return sum;
}

/// The area within the chords.
double outline_area(const ParametricMesh& mesh) {
  double sum = 0.0;
  for (const TrimPiece& piece : mesh.boundary) {
    const Parameters& a = mesh.parameters[piece.nodes[0]];
    const Parameters& b = mesh.parameters[piece.nodes[1]];
    sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return sum;
}

double largest_slide(const RefinableFace& face) {
  const SurfacePoints surface(face.surface);
  double largest = 0.0;
  for (const auto& t : face.mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = t[k];
      const std::uint32_t j = t[(k + 1) % 3];
      const Parameters& a = face.mesh.parameters[i];
      const Parameters& b = face.mesh.parameters[j];
      const Point on = surface.point({0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])});
      double square = 0.0;
      for (std::size_t x = 0; x < 3; ++x) {
        const double flat = 0.5 * (face.mesh.points[i][x] + face.mesh.points[j][x]);
        square += (on[x] - flat) * (on[x] - flat);
      }
      largest = std::max(largest, std::sqrt(square));
    }
  }
  return largest;
}

/// The ends of the pieces of an edge, each piece as a pair of points.
std::set<std::set<Point>> pieces_of(const RefinableFace& face, std::uint32_t edge) {
  std::set<std::set<Point>> result;
  for (std::size_t i = 0; i < face.sources.size(); ++i) {
    if (!face.sources[i].piece || face.sources[i].piece->edge != edge) continue;
    const auto& nodes = face.mesh.boundary[i].nodes;
    result.insert({face.mesh.points[nodes[0]], face.mesh.points[nodes[1]]});
  }
  return result;
}

/// Expects the properties that every refined face has.
void expect_sound(const RefinableFace& face) {
  const ParametricMesh& mesh = face.mesh;
  EXPECT_EQ(error_of(face.surface, mesh).error, "") << "the outline is the boundary";
  for (const auto& t : mesh.triangles) EXPECT_GT(area(mesh, t), 0.0);
  EXPECT_NEAR(area(mesh), outline_area(mesh), 1e-12);
  ASSERT_EQ(face.sources.size(), mesh.boundary.size());
  for (std::size_t i = 0; i < face.sources.size(); ++i) {
    const BoundarySource& source = face.sources[i];
    const PlaneCurve& curve = face.curves[source.curve];
    const std::array<double, 2> ends = {source.from, source.to};
    for (std::size_t k = 0; k < 2; ++k) {
      const Parameters on = hull_of(curve, ends[k], ends[k]).front();
      const Parameters& node = mesh.parameters[mesh.boundary[i].nodes[k]];
      EXPECT_NEAR(std::hypot(on[0] - node[0], on[1] - node[1]), 0.0, 1e-14);
    }
  }
}

TEST(EdgeRefinement, NoSideSlidesAndNeighboursShareTheirNodes) {
  Random random(kRefinementSeed);
  for (const double bumps : {0.0, 0.1, 0.4}) {
    for (int i = 0; i < 10; ++i) {
      SCOPED_TRACE(::testing::Message() << bumps << " " << i);
      Pair pair(random, bumps);
      pair.refine(kTolerance);
      for (const RefinableFace* face : {&pair.a, &pair.b}) {
        expect_sound(*face);
        EXPECT_NEAR(area(face->mesh), 1.0, 1e-12);
        pair.expect_nodes_on_edges(*face);
        EXPECT_LE(largest_slide(*face), kTolerance + kBeside);
        EXPECT_LE(*error_of(face->surface, face->mesh), 2.5 * kTolerance);
        EXPECT_LE(face->mesh.triangles.size(), 20'000U);
      }
      EXPECT_EQ(pieces_of(pair.a, kSharedEdge), pieces_of(pair.b, kSharedEdge));
      EXPECT_GT(pieces_of(pair.a, kSharedEdge).size(), 4U);
    }
  }
}

TEST(EdgeRefinement, ASideThatDoesNotSlideIsNotSplit) {
  Random random(kRefinementSeed);
  Pair pair(random, 0.1);
  pair.refine(10.0);
  EXPECT_EQ(pair.a.mesh.triangles.size(), 2U);
  EXPECT_EQ(pair.b.mesh.triangles.size(), 2U);
}

TEST(EdgeRefinement, AFaceThatDoesNotSlideIsSplitWithItsNeighbour) {
  Random random(kRefinementSeed);
  Pair pair(random, 0.1);
  // The second becomes a plane with even parameters along x, and the shared edge stays uneven.
  for (std::size_t i = 0; i < 16; ++i) {
    const WeightedPoint& edge = pair.b.surface.surface.points[i - i % 4];
    WeightedPoint& point = pair.b.surface.surface.points[i];
    const double x = static_cast<double>(i % 4) / 3.0;
    point = {edge[0] + edge[3] * x, edge[1], edge[2], edge[3]};
  }
  for (std::size_t i = 0; i < 4; ++i) {
    pair.b.mesh.points[i] = SurfacePoints(pair.b.surface).point(pair.b.mesh.parameters[i]);
  }
  pair.b.mesh.points[0] = pair.a.mesh.points[1];
  pair.b.mesh.points[3] = pair.a.mesh.points[2];
  pair.refine(kTolerance);
  expect_sound(pair.a);
  expect_sound(pair.b);
  EXPECT_EQ(pieces_of(pair.a, kSharedEdge), pieces_of(pair.b, kSharedEdge));
}

TEST(EdgeRefinement, PiecesThatFacesDoNotShareAlikeStay) {
  Random random(kRefinementSeed);
  Pair pair(random, 0.1);
  pair.b.mesh.points[0][2] += 1e-9;
  pair.refine(kTolerance);
  expect_sound(pair.a);
  expect_sound(pair.b);
  EXPECT_EQ(pieces_of(pair.a, kSharedEdge).size(), 1U);
  EXPECT_EQ(pieces_of(pair.b, kSharedEdge).size(), 1U);
  EXPECT_GT(pair.a.mesh.triangles.size(), 100U);
}

TEST(EdgeRefinement, AFaceThatDoesNotFitTogetherStaysWithItsEdges) {
  Random random(kRefinementSeed);
  Pair pair(random, 0.1);
  pair.b.mesh.triangles.pop_back();
  pair.refine(kTolerance);
  EXPECT_EQ(pair.b.mesh.triangles.size(), 1U);
  EXPECT_EQ(pieces_of(pair.a, kSharedEdge).size(), 1U);
  expect_sound(pair.a);
}

TEST(EdgeRefinement, StopsBeforeThereAreTooManyTriangles) {
  Random random(kRefinementSeed);
  for (const std::size_t most : {4U, 50U, 1000U}) {
    Pair pair(random, 0.4);
    pair.refine(1e-9, most);
    const std::size_t triangles = pair.a.mesh.triangles.size() + pair.b.mesh.triangles.size();
    EXPECT_LE(triangles, most);
    EXPECT_GE(triangles, most / 4);
    expect_sound(pair.a);
    expect_sound(pair.b);
  }
}

/// A plane within a circle of four chords, or outside of it within a square, with u and v as x, y.
RefinableFace round_face(bool is_hole) {
  RefinableFace face;
  face.surface.surface = {
      2, 2, {0, 0, 1, 1}, {0, 0, 1, 1}, {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 0, 1}}};
  constexpr double kRadius = 0.4;
  const double w = std::sqrt(0.5);
  const std::array<Parameters, 4> around = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  for (std::size_t k = 0; k < 4; ++k) {
    const Parameters a = around[k];
    const Parameters b = around[(k + 1) % 4];
    const auto at = [&](double x, double y, double weight) {
      return WeightedPoint{weight * (0.5 + kRadius * x), weight * (0.5 + kRadius * y), 0, weight};
    };
    face.curves.push_back({{at(a[0], a[1], 1), at(a[0] + b[0], a[1] + b[1], w), at(b[0], b[1], 1)},
                           {0, 0, 0, 1, 1, 1},
                           0.0});
    face.mesh.parameters.push_back({0.5 + kRadius * a[0], 0.5 + kRadius * a[1]});
    const auto i = static_cast<std::uint32_t>(k);
    const std::uint32_t next = (i + 1) % 4;
    TrimPiece piece{{i, next}, hull_of(face.curves[k], 0.0, 1.0)};
    BoundarySource source{EdgePiece{i, 1}, k, 0.0, 1.0};
    if (is_hole) std::swap(piece.nodes[0], piece.nodes[1]);
    if (is_hole) std::swap(source.from, source.to);
    face.mesh.boundary.push_back(piece);
    face.sources.push_back(source);
  }
  if (is_hole) {
    // Corners 4 to 7 of a square that is turned by 45 degrees to the chords.
    for (const Parameters& at : {Parameters{1, 1}, {0, 1}, {0, 0}, {1, 0}}) {
      face.mesh.parameters.push_back(at);
    }
    face.curves.push_back(line({0, 0}, {1, 1}));  // unused: the square is never split
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t next = (k + 1) % 4;
      face.mesh.triangles.push_back({next, k, 4 + k});
      face.mesh.triangles.push_back({next, 4 + k, 4 + next});
      face.mesh.boundary.push_back({{4 + k, 4 + next}, {}});
      face.sources.push_back({std::nullopt, 4, 0.0, 0.0});
    }
  } else {
    face.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  }
  for (const Parameters& at : face.mesh.parameters) face.mesh.points.push_back({at[0], at[1], 0});
  return face;
}

TEST(EdgeRefinement, TrimCurvesThatSagAreSplitAndNothingTurnsOver) {
  for (const bool is_hole : {false, true}) {
    SCOPED_TRACE(is_hole);
    RefinableFace face = round_face(is_hole);
    ASSERT_TRUE(error_of(face.surface, face.mesh));
    const std::array<RefinableFace*, 1> faces = {&face};
    const auto circle = [&](std::uint32_t edge, double t) {
      const Parameters at = hull_of(face.curves[edge], t, t).front();
      return Point{at[0], at[1], 0.0};
    };
    refine_sides(faces, circle, kTolerance, kMany);
    for (const auto& t : face.mesh.triangles) EXPECT_GE(area(face.mesh, t), 0.0);
    EXPECT_NEAR(area(face.mesh), outline_area(face.mesh), 1e-12);
    const double disc = std::numbers::pi * 0.4 * 0.4;
    EXPECT_NEAR(area(face.mesh), is_hole ? 1.0 - disc : disc, 2e-3);
    const base::Result<double> error = error_of(face.surface, face.mesh);
    ASSERT_TRUE(error) << error.error;
    EXPECT_LE(*error, 1.01 * kTolerance);
  }
}

TEST(EdgeRefinement, ASplitThatWouldTurnATriangleOverIsNotMade) {
  // The curve along the lowest side runs beyond the opposite corner in its middle, or not quite.
  for (const double corner : {0.1, 0.3}) {
    SCOPED_TRACE(corner);
    RefinableFace face = round_face(false);
    face.mesh.parameters = {{0, 0}, {1, 0}, {0.5, corner}};
    face.mesh.points = {{0, 0, 0}, {1, 0, 0}, {0.5, corner, 0}};
    face.mesh.triangles = {{0, 1, 2}};
    face.curves = {{{{0, 0, 0, 1}, {0.5, 0.4, 0, 1}, {1, 0, 0, 1}}, {0, 0, 0, 1, 1, 1}, 0.0}};
    face.mesh.boundary = {{{0, 1}, hull_of(face.curves[0], 0, 1)}, {{1, 2}, {}}, {{2, 0}, {}}};
    face.sources = {{EdgePiece{0, 1}, 0, 0.0, 1.0}, {}, {}};
    const std::array<RefinableFace*, 1> faces = {&face};
    const auto curve = [&](std::uint32_t, double t) {
      const Parameters at = hull_of(face.curves[0], t, t).front();
      return Point{at[0], at[1], 0.0};
    };
    refine_sides(faces, curve, 0.05, kMany);
    EXPECT_EQ(error_of(face.surface, face.mesh).error, "");
    if (corner < 0.2) {
      EXPECT_EQ(face.mesh.triangles.size(), 1U);
    } else {
      EXPECT_GT(face.mesh.triangles.size(), 1U);
    }
  }
}

}  // namespace
}  // namespace camway::scene::surfaces
