// SPDX-License-Identifier: MIT
#include "daemon/motion/body/body_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tests/support/random.h"

namespace camway::motion {
namespace {

using geometry::Triangle;
using geometry::Vec3;

std::vector<Triangle> random_triangles(testing::Random& random, int count, double size_m) {
  const Vec3 center = random.in_cube(3.0);
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = center + random.in_cube(1.0);
    triangles.push_back(
        {at, at + random.in_cube(size_m), random.chance(0.1) ? at : at + random.in_cube(size_m)});
  }
  return triangles;
}

double radius_m(const std::vector<Triangle>& triangles) {
  double radius_m = 0.0;
  for (const Triangle& triangle : triangles) {
    for (const Vec3& vertex : triangle) radius_m = std::max(radius_m, vertex.norm());
  }
  return radius_m * (1.0 + 1e-12);
}

long double distance(const Vec3& a, const Vec3& b) {
  return (a.cast<long double>() - b.cast<long double>()).norm();
}

TEST(BodyTree, BallsHoldTheirTrianglesAndChildrenShareThem) {
  testing::Random random(1801);
  for (int trial = 0; trial < 40; ++trial) {
    const int count = random.integer(1, 400);
    const std::vector<Triangle> triangles =
        random_triangles(random, count, random.log_uniform(1e-9, 1.0));
    const double radius = radius_m(triangles);
    const BodyTree tree(triangles, radius);
    for (std::size_t i = 0; i < tree.nodes().size(); ++i) {
      const BodyTree::Node& node = tree.nodes()[i];
      EXPECT_LE(node.center_C.norm(), radius * (1.0 + 1e-12));
      for (std::uint32_t k = node.begin; k < node.end; ++k) {
        for (const Vec3& vertex : triangles[tree.order()[k]]) {
          ASSERT_LE(distance(vertex, node.center_C), node.radius_m);
        }
      }
      if (node.is_leaf()) {
        EXPECT_LE(node.end - node.begin, BodyTree::kLeafTriangles);
        continue;
      }
      const BodyTree::Node& first = tree.nodes()[i + 1];
      const BodyTree::Node& second = tree.nodes()[node.second_child];
      EXPECT_EQ(first.begin, node.begin);
      EXPECT_EQ(first.end, second.begin);
      EXPECT_EQ(second.end, node.end);
    }
    std::vector<std::uint32_t> order(tree.order().begin(), tree.order().end());
    std::ranges::sort(order);
    std::vector<std::uint32_t> all(triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(order, all);
  }
}

TEST(BodyTree, EqualTrianglesAreDividedAllTheSame) {
  const std::vector<Triangle> triangles(1000,
                                        Triangle{Vec3(1, 2, 3), Vec3(1, 2, 4), Vec3(1, 3, 3)});
  const BodyTree tree(triangles, radius_m(triangles));
  EXPECT_LE(tree.nodes().size(), 512U);
}

}  // namespace
}  // namespace camway::motion
