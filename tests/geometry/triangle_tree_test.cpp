// SPDX-License-Identifier: MIT
#include "daemon/geometry/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "daemon/geometry/winding.h"
#include "tests/geometry/random_triangles.h"
#include "tests/support/body_meshes.h"

namespace camway::geometry {
namespace {

std::vector<Triangle> triangles_of(const motion::MeshShape& mesh) {
  std::vector<Triangle> triangles;
  for (const auto& t : mesh.triangles)
    triangles.push_back({mesh.vertices_C[t[0]], mesh.vertices_C[t[1]], mesh.vertices_C[t[2]]});
  return triangles;
}

/// Coordinates of any size, also far from the origin; coincident and degenerate triangles.
std::vector<Triangle> random_triangles(RandomTriangles& random, int count) {
  const Vec3 middle = random.in_cube(random.log_uniform(1e-3, 1e6));
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    Triangle t = random.thin_triangle();
    for (Vec3& vertex : t) vertex += middle;
    triangles.push_back(random.chance(0.2) && i > 0 ? triangles.back() : t);
  }
  return triangles;
}

TEST(TriangleTree, ItsBoxesHoldTheirTriangles) {
  RandomTriangles random(4711);
  for (const int count : {1, 2, 4, 5, 8, 9, 33, 500}) {
    const std::vector<Triangle> triangles = random_triangles(random, count);
    const TriangleTree tree(triangles);
    std::vector<std::uint32_t> order(tree.order().begin(), tree.order().end());
    for (const TriangleTree::Node& node : tree.nodes()) {
      ASSERT_LT(node.begin, node.end);
      EXPECT_EQ(node.is_leaf(), node.end - node.begin <= TriangleTree::kLeafTriangles);
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        for (const Vec3& vertex : triangles[order[i]]) {
          // Exact: the sums of doubles are compared in a type that holds them.
          for (int k = 0; k < 3; ++k) {
            const long double away = std::abs(static_cast<long double>(vertex[k]) -
                                              static_cast<long double>(node.center[k]));
            ASSERT_LE(away, static_cast<long double>(node.half[k]));
          }
          EXPECT_LE(vertex.norm(), node.radius_m);
        }
      }
    }
    std::ranges::sort(order);
    for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
  }
}

TEST(TriangleTree, ChildrenShareTheTrianglesOfTheirParent) {
  RandomTriangles random(4712);
  const TriangleTree tree(random_triangles(random, 1000));
  for (std::uint32_t i = 0; i < tree.nodes().size(); ++i) {
    const TriangleTree::Node& node = tree.nodes()[i];
    if (node.is_leaf()) continue;
    const TriangleTree::Node& first = tree.nodes()[i + 1];
    const TriangleTree::Node& second = tree.nodes()[node.second_child];
    EXPECT_EQ(first.begin, node.begin);
    EXPECT_EQ(first.end, second.begin);
    EXPECT_EQ(second.end, node.end);
  }
}

// Which points are inside is known in closed form, but for a thin shell between the torus and its
// faces.
TEST(WindingNumber, TellsTheInsideOfATorus) {
  testing::Random random(4713);
  constexpr double kWide_m = 1.0;
  constexpr double kThin_m = 0.4;
  const std::vector<Triangle> triangles = triangles_of(testing::torus(kWide_m, kThin_m, 60, 30));
  const TriangleTree tree(triangles);
  const double shell_m = 0.02;  // more than the arrow of an arc of 12 degrees
  int inside = 0;
  for (int run = 0; run < 3000; ++run) {
    Vec3 point = random.in_cube(1.5);
    if (run % 3 == 0) point = triangles[static_cast<std::size_t>(random.integer(0, 3599))][0] * 0.9;
    const double ring_m = std::hypot(point.x(), point.y()) - kWide_m;
    const double away_m = std::hypot(ring_m, point.z());
    if (std::abs(away_m - kThin_m) < shell_m) continue;
    const std::optional<int> winding = winding_number(point, triangles, tree);
    ASSERT_TRUE(winding);
    EXPECT_EQ(*winding, away_m < kThin_m ? 1 : 0);
    inside += *winding;
  }
  EXPECT_GT(inside, 100);
}

// Rays through vertices and along edges and faces: a grid cube, asked at points of the same grid.
TEST(WindingNumber, IsExactWhereRaysMeetEdgesAndVertices) {
  std::vector<Triangle> triangles;
  const auto add_cube = [&](const Vec3& low, double side) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = side * Vec3::Unit((k + 1) % 3);
      const Vec3 v = side * Vec3::Unit((k + 2) % 3);
      const Vec3 up = low + side * Vec3::Unit(k);
      triangles.push_back({low, low + v, low + u + v});
      triangles.push_back({low, low + u + v, low + u});
      triangles.push_back({up, up + u, up + u + v});
      triangles.push_back({up, up + u + v, up + v});
    }
  };
  add_cube({0, 0, 0}, 4.0);
  add_cube({2, 2, 2}, 4.0);  // overlaps the first one
  const TriangleTree tree(triangles);
  const auto is_in = [](const Vec3& p, double low) {
    return (p.array() > low).all() && (p.array() < low + 4.0).all();
  };
  const auto is_on = [&](const Vec3& p, double low) {
    return !is_in(p, low) && (p.array() >= low).all() && (p.array() <= low + 4.0).all();
  };
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p(i % 10 - 1, i / 10 % 10 - 1, i / 100 - 1);
    if (is_on(p, 0.0) || is_on(p, 2.0)) continue;
    EXPECT_EQ(winding_number(p, triangles, tree), int{is_in(p, 0.0)} + int{is_in(p, 2.0)})
        << p.transpose();
  }
  EXPECT_FALSE(winding_number({4, 1.5, 1.25}, triangles, tree)) << "on a face";
}

}  // namespace
}  // namespace camway::geometry
