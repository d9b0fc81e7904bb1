// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/separation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "tests/support/closed_meshes.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/separation_checker.h"

namespace camway::correction {
namespace {

using geometry::Vec3;
using testing::SeparationChecker;

std::optional<Separation> separation(const scene::Mesh& mesh, const std::vector<Vec3>& points) {
  return find_separation(mesh, find_closed_surfaces(mesh), points, 0.0);
}

/// Expects a separating surface, which an independent checker confirms.
void expect_separated(const scene::Mesh& mesh, const std::vector<Vec3>& points, std::size_t inside,
                      std::size_t outside, std::size_t triangles) {
  const std::optional<Separation> found = separation(mesh, points);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->inside, inside);
  EXPECT_EQ(found->outside, outside);
  EXPECT_EQ(found->triangles.size(), triangles);
  EXPECT_EQ(SeparationChecker(mesh, found->triangles)
                .check(points[found->inside], points[found->outside]),
            "");
}

scene::Mesh cuboid() {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, Vec3(-1, -1, -1), Vec3(1, 1, 1));
  return mesh;
}

/// Returns the mesh with separate vertices for each triangle, as in STL files.
scene::Mesh soup(const scene::Mesh& mesh) {
  scene::Mesh result;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const geometry::Triangle corners = mesh.triangle(t);
    testing::add_triangle(result, corners[0], corners[1], corners[2]);
  }
  return result;
}

void append(scene::Mesh& mesh, const scene::Mesh& other) {
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) {
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

TEST(Separation, CuboidSeparatesInsideFromOutside) {
  expect_separated(cuboid(), {Vec3(0.1, 0.2, 0.3), Vec3(3, 0, 0)}, 0, 1, 12);
  expect_separated(cuboid(), {Vec3(3, 0, 0), Vec3(-3, 0, 0), Vec3(0, 0, 0)}, 2, 0, 12);
  expect_separated(soup(cuboid()), {Vec3(0.1, 0.2, 0.3), Vec3(3, 0, 0)}, 0, 1, 12);
}

TEST(Separation, NothingSeparatesPointsOfOneSide) {
  EXPECT_FALSE(separation(cuboid(), {Vec3(0, 0, 0), Vec3(0.9, 0.9, 0.9)}));
  EXPECT_FALSE(separation(cuboid(), {Vec3(-3, 0, 0), Vec3(3, 0, 0), Vec3(0, 3, 3)}));
  EXPECT_FALSE(separation(cuboid(), {Vec3(0, 0, 0)}));
  EXPECT_FALSE(separation(cuboid(), {}));
  EXPECT_FALSE(separation(scene::Mesh{}, {Vec3(0, 0, 0), Vec3(1, 0, 0)}));
}

TEST(Separation, RaysThroughVerticesEdgesAndPlanes) {
  scene::Mesh mesh;
  testing::add_octahedron(mesh, Vec3::Zero(), 1.0);
  // From the centre, and from points outside in front and behind, the ray meets two vertices; at y
  // = ±1 it touches one; at z = 0 it meets edges.
  expect_separated(mesh, {Vec3(0, 0, 0), Vec3(-2, 0, 0)}, 0, 1, 8);
  expect_separated(mesh, {Vec3(-2, 1, 0), Vec3(0, 0.5, 0)}, 1, 0, 8);
  expect_separated(mesh, {Vec3(-2, 0, 1), Vec3(0, -0.5, 0)}, 1, 0, 8);
  EXPECT_FALSE(separation(mesh, {Vec3(-2, 0, 0), Vec3(2, 0, 0), Vec3(-2, 1, 0), Vec3(-2, 0, -1)}));
  // Points in the planes of faces.
  expect_separated(cuboid(), {Vec3(-3, 1, 0), Vec3(-3, -1, -1), Vec3(0, 0, 0)}, 2, 0, 12);
  EXPECT_FALSE(separation(cuboid(), {Vec3(-3, 1, 1), Vec3(-3, -1, 0), Vec3(1, 3, 0)}));
}

TEST(Separation, PointsOnASurfaceOrTooNearAreNotSeparatedByIt) {
  EXPECT_FALSE(separation(cuboid(), {Vec3(1, 0.5, 0.25), Vec3(3, 0, 0)}));
  EXPECT_FALSE(separation(cuboid(), {Vec3(1, 1, 0.25), Vec3(0, 0, 0)}));
  EXPECT_FALSE(separation(cuboid(), {Vec3(-1, -1, -1), Vec3(0, 0, 0)}));
  const scene::ClosedSurfaces surfaces = find_closed_surfaces(cuboid());
  const std::vector<Vec3> points = {Vec3(0.5, 0, 0), Vec3(3, 0, 0)};
  EXPECT_TRUE(find_separation(cuboid(), surfaces, points, 0.49));
  EXPECT_FALSE(find_separation(cuboid(), surfaces, points, 0.5));
  EXPECT_FALSE(find_separation(cuboid(), surfaces, points, std::nan("")));
}

TEST(Separation, SphereAndTorus) {
  scene::Mesh sphere;
  testing::add_sphere(sphere, Vec3(0.3, 0.1, -0.7), 1.0, 3);
  expect_separated(sphere, {Vec3(0.3, 0.1, -0.7), Vec3(2, 0, 0)}, 0, 1, 512);

  scene::Mesh torus;
  testing::add_torus(torus, Vec3::Zero(), 2.0, 0.5);
  const Vec3 in_tube(0.0, 0.1, 2.0);
  expect_separated(torus, {Vec3(0, 0, 0), in_tube}, 1, 0, 24 * 12 * 2);
  EXPECT_FALSE(separation(torus, {Vec3(0, 0, 0), Vec3(4, 0, 0)})) << "the hole is outside";
}

TEST(Separation, NestedShells) {
  scene::Mesh mesh;
  testing::add_sphere(mesh, Vec3::Zero(), 3.0, 2);
  testing::add_sphere(mesh, Vec3::Zero(), 2.0, 1);
  const Vec3 inner(0, 0, 0);
  const Vec3 between(2.5, 0, 0);
  const Vec3 outer(4, 0, 0);
  expect_separated(mesh, {inner, between}, 0, 1, 32);
  expect_separated(mesh, {between, outer}, 0, 1, 128);
  // Both surfaces separate the points; the inner one is smaller.
  expect_separated(mesh, {outer, inner}, 1, 0, 32);
}

TEST(Separation, RoomsThatShareAWall) {
  const scene::Mesh mesh = testing::two_rooms();
  ASSERT_EQ(mesh.triangles.size(), 22U);
  const Vec3 left(-0.5, 0.5, 0.5);
  const Vec3 right(0.5, 0.4, 0.6);
  const Vec3 away(5, 0.5, 0.5);
  for (const scene::Mesh& m : {mesh, soup(mesh)}) {
    expect_separated(m, {left, away}, 0, 1, 12);
    expect_separated(m, {away, right}, 1, 0, 12);
    const std::optional<Separation> found = separation(m, {left, right});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->triangles.size(), 12U);
  }
}

TEST(Separation, AWallTakenAwayMakesOneRoomOfTwo) {
  scene::Mesh mesh = testing::two_rooms();
  std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](std::uint32_t v) { return mesh.vertices[v].x() == 0.0; });
  });
  ASSERT_EQ(mesh.triangles.size(), 20U);
  EXPECT_FALSE(separation(mesh, {Vec3(-0.5, 0.5, 0.5), Vec3(0.5, 0.4, 0.6)}));
  expect_separated(mesh, {Vec3(-0.5, 0.5, 0.5), Vec3(5, 0.5, 0.5)}, 0, 1, 20);
}

TEST(Separation, SlitsAreNotClosed) {
  scene::Mesh without_one = cuboid();
  without_one.triangles.pop_back();
  EXPECT_FALSE(separation(without_one, {Vec3(0, 0, 0), Vec3(3, 0, 0)}));

  scene::Mesh rounded = soup(cuboid());
  rounded.vertices[0].x() = std::nextafter(rounded.vertices[0].x(), 2.0);
  EXPECT_FALSE(separation(rounded, {Vec3(0, 0, 0), Vec3(3, 0, 0)}));

  // An edge that ends in the middle of another: the face x = 1 is a fan about a point on its edge.
  scene::Mesh fan = soup(cuboid());
  fan.triangles.erase(fan.triangles.end() - 2, fan.triangles.end());
  const Vec3 on_edge(1, 0, 1);
  testing::add_triangle(fan, on_edge, Vec3(1, 1, 1), Vec3(1, 1, -1));
  testing::add_triangle(fan, on_edge, Vec3(1, 1, -1), Vec3(1, -1, -1));
  testing::add_triangle(fan, on_edge, Vec3(1, -1, -1), Vec3(1, -1, 1));
  EXPECT_FALSE(separation(fan, {Vec3(0, 0, 0), Vec3(3, 0, 0)}));
}

TEST(Separation, ZeroHasOneSign) {
  scene::Mesh mesh = soup(testing::two_rooms());
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 2) {
    for (double& x : mesh.vertices[i]) x = x == 0.0 ? -0.0 : x;
  }
  EXPECT_TRUE(separation(mesh, {Vec3(-0.5, 0.5, 0.5), Vec3(0.5, 0.4, 0.6)}));
}

TEST(Separation, CopiesOfTrianglesAndLooseOnesDoNotMatter) {
  scene::Mesh doubled = cuboid();
  append(doubled, soup(cuboid()));
  expect_separated(doubled, {Vec3(0, 0, 0), Vec3(3, 0, 0)}, 0, 1, 12);

  scene::Mesh one_twice = cuboid();
  const std::array<std::uint32_t, 3> t = one_twice.triangles[5];
  one_twice.triangles.push_back({t[1], t[0], t[2]});
  expect_separated(one_twice, {Vec3(0, 0, 0), Vec3(3, 0, 0)}, 0, 1, 12);

  // A fin on an edge: its edge has three triangles, and the fin has more.
  scene::Mesh fin = cuboid();
  testing::add_triangle(fin, Vec3(1, 1, 1), Vec3(1, 1, -1), Vec3(2, 2, 0));
  testing::add_triangle(fin, Vec3(1, 1, 1), Vec3(2, 2, 0), Vec3(2, 2, 3));
  expect_separated(fin, {Vec3(0, 0, 0), Vec3(3, 0, 0)}, 0, 1, 12);
  fin.triangles.push_back({0, 0, 3});
  expect_separated(fin, {Vec3(0, 0, 0), Vec3(3, 0, 0)}, 0, 1, 12);
}

TEST(Separation, SurfacesWithoutOrientationThatPassThroughThemselves) {
  scene::Mesh mesh;
  testing::add_klein_bottle(mesh, 2.0, 0.75);
  // Each half of the eight is a tube; both are one tube, since they swap places after a turn.
  expect_separated(mesh, {Vec3(5, 0, 0), Vec3(2.4, 0.05, 0.0)}, 1, 0, 40 * 24 * 2);
  expect_separated(mesh, {Vec3(1.6, 0.05, 0.0), Vec3(0, 0, 0)}, 0, 1, 40 * 24 * 2);
  EXPECT_FALSE(separation(mesh, {Vec3(1.6, 0.05, 0.0), Vec3(2.4, 0.05, 0.0)}));
}

TEST(Separation, WhereTwoSolidsOverlapEachCountsForItself) {
  scene::Mesh mesh = cuboid();
  testing::add_cuboid(mesh, Vec3(0, 0, 0), Vec3(4, 4, 4));
  expect_separated(mesh, {Vec3(0.5, 0.5, 0.5), Vec3(9, 9, 9)}, 0, 1, 12);
  expect_separated(mesh, {Vec3(0.5, 0.5, 0.5), Vec3(-0.5, 0.5, 0.5)}, 0, 1, 12);
}

// 30,000 bricks with common walls: too many seams to eliminate all of them, but the brick around a
// point is still found.
TEST(Separation, SpaceFilledWithBricks) {
  scene::Mesh mesh;
  for (int i = 0; i < 30'000; ++i) {
    const Vec3 corner(i % 30, i / 30 % 30, i / 900);
    testing::add_cuboid(mesh, corner, corner + Vec3(1, 1, 1));
  }
  EXPECT_FALSE(find_closed_surfaces(mesh).complete);
  expect_separated(mesh, {Vec3(15.5, 15.25, 15.75), Vec3(-5, 0, 0)}, 0, 1, 12);
  expect_separated(mesh, {Vec3(-5, 0, 0), Vec3(15.5, 15.25, 15.75)}, 1, 0, 12);
}

/// Returns sums of tetrahedra on a small lattice, with copies, holes and loose triangles.
scene::Mesh random_mesh(testing::Random& random) {
  std::uniform_int_distribution<int> lattice(0, 3);
  const auto vertex = [&] { return Vec3(lattice(random), lattice(random), lattice(random)); };
  scene::Mesh mesh;
  std::array<Vec3, 4> v = {vertex(), vertex(), vertex(), vertex()};
  for (int left = std::uniform_int_distribution<int>(1, 5)(random); left > 0; --left) {
    testing::add_tetrahedron(mesh, v);
    // Every second one shares a face with the one before.
    for (std::size_t k = random() % 2 == 0 ? 3 : 0; k < 4; ++k) v[k] = vertex();
  }
  for (int left = lattice(random); left > 0; --left) {
    testing::add_triangle(mesh, vertex(), vertex(), vertex());
  }
  for (int left = lattice(random); left > 1; --left) {
    mesh.triangles.erase(mesh.triangles.begin() +
                         static_cast<std::ptrdiff_t>(random() % mesh.triangles.size()));
  }
  return mesh;
}

/// Returns whether a closed surface of at most 64 triangles has exactly one of the points inside.
/// There is none exactly if the set of triangles that a path between the points crosses is a sum
/// modulo 2 of stars of edges (linear algebra: a functional that is 0 on a kernel).
bool some_surface_separates(const scene::Mesh& mesh, const Vec3& a, const Vec3& b) {
  std::map<std::array<std::array<double, 3>, 2>, std::uint64_t> stars;
  std::uint64_t crossed = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint64_t bit = std::uint64_t{1} << t;
    const geometry::Triangle v = mesh.triangle(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto key = [](const Vec3& p) { return std::array<double, 3>{p.x(), p.y(), p.z()}; };
      std::array<std::array<double, 3>, 2> edge = {key(v[k]), key(v[(k + 1) % 3])};
      if (edge[0] == edge[1]) continue;
      if (edge[1] < edge[0]) std::swap(edge[0], edge[1]);
      stars[edge] ^= bit;
    }
    const SeparationChecker one(mesh, std::vector<std::uint32_t>{t});
    if (one.odd_from(a) != one.odd_from(b)) crossed |= bit;
  }
  std::vector<std::uint64_t> basis;
  const auto reduced = [&](std::uint64_t row) {
    for (const std::uint64_t other : basis) row = std::min(row, row ^ other);
    return row;
  };
  for (const auto& [edge, star] : stars) {
    if (const std::uint64_t row = reduced(star); row != 0) basis.push_back(row);
  }
  return reduced(crossed) != 0;
}

TEST(Separation, RandomSurfacesAgainstLinearAlgebraAndTheChecker) {
  constexpr int kCases = 20'000;
  testing::Random random(41);
  // Half of the coordinates are those of vertices, so that rays pass through vertices and edges.
  std::uniform_int_distribution<int> quarter(-1, 13);
  const auto point = [&] {
    return Vec3(quarter(random) / 4.0, quarter(random) / 4.0, quarter(random) / 4.0);
  };
  int found_some = 0;
  int found_none = 0;
  for (int i = 0; i < kCases; ++i) {
    const scene::Mesh mesh = random_mesh(random);
    // At the centre of four vertices, which often belong to one tetrahedron, and at random.
    const std::size_t first = random() % (mesh.vertices.size() - 3);
    const std::vector<Vec3> points = {(mesh.vertices[first] + mesh.vertices[first + 1] +
                                       mesh.vertices[first + 2] + mesh.vertices[first + 3]) /
                                          4.0,
                                      point()};
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    const SeparationChecker everything(mesh, all);
    if (!everything.odd_from(points[0]) || !everything.odd_from(points[1])) continue;  // touches
    const std::optional<Separation> found = separation(mesh, points);
    ASSERT_EQ(found.has_value(), some_surface_separates(mesh, points[0], points[1])) << i;
    if (!found) {
      ++found_none;
      continue;
    }
    ++found_some;
    ASSERT_EQ(SeparationChecker(mesh, found->triangles)
                  .check(points[found->inside], points[found->outside]),
              "")
        << i;
  }
  EXPECT_GT(found_some, kCases / 20);
  EXPECT_GT(found_none, kCases / 20);
}

}  // namespace
}  // namespace camway::correction
