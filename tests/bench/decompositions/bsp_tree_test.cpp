// SPDX-License-Identifier: MIT
#include "tests/bench/decompositions/bsp_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/scene/index/index_oracle.h"
#include "tests/scene/test_meshes.h"

namespace camway::bench {
namespace {

using geometry::moved;
using geometry::RandomTriangles;
using geometry::Triangle;
using geometry::Vec3;
using scene::kInfinity;
using scene::Mesh;
using scene::SceneIndex;

/// A BSP tree, and the triangles of the same mesh for the oracles.
class Tested {
 public:
  explicit Tested(Mesh mesh, const BspOptions& options = {})
      : mesh_(std::make_shared<const Mesh>(std::move(mesh))),
        all_(SceneIndex::build(mesh_)),
        tree_(mesh_, options) {
    std::printf("%zu triangles: %zu nodes, %zu leaves, depth %u, %zu pieces\n",
                mesh_->triangles.size(), tree_.nodes(), tree_.leaves(), tree_.depth(),
                tree_.references());
    EXPECT_LE(tree_.depth(), options.max_depth);
    EXPECT_GE(tree_.references(), mesh_->triangles.size());
    EXPECT_LE(static_cast<double>(tree_.references()),
              options.max_duplication * static_cast<double>(mesh_->triangles.size()));
  }

  [[nodiscard]] const BspTree& tree() const { return tree_; }

  /// Compares all answers about a body with those of a loop over all triangles.
  void expect_right(std::span<const Triangle> body, double cutoff_m) const {
    const auto expected = scene::brute_nearest(all_, body, cutoff_m);
    scene::expect_equal(tree_.nearest(body, cutoff_m), expected);
    const auto any = tree_.any_within(body, cutoff_m);
    ASSERT_EQ(any.has_value(), expected.has_value());
    if (any) {
      EXPECT_GE(any->distance_m, expected->distance_m);
      EXPECT_LT(any->distance_m, cutoff_m);
    }
    bool touches = false;
    for (const Triangle& part : body) {
      touches = touches || scene::brute_first_intersection(all_, part).has_value();
    }
    EXPECT_EQ(tree_.touches(body), touches);
  }

 private:
  std::shared_ptr<const Mesh> mesh_;
  SceneIndex all_;
  BspTree tree_;
};

TEST(BspTree, AnswersAsALoopOverASoup) {
  RandomTriangles random(531);
  for (const std::uint32_t threshold : {1U, 8U}) {
    const Tested tested(scene::mesh_of_triangles(scene::soup(random, 700)),
                        {.threshold = threshold});
    for (int i = 0; i < 1500; ++i) {
      const Vec3 at = random.in_cube(6.0);
      const double size = random.log_uniform(1e-3, 2.0);
      const std::array<Triangle, 2> body = {
          Triangle{at, at + random.in_cube(size), at + random.in_cube(size)},
          Triangle{at, at + random.in_cube(size), at + random.in_cube(size)}};
      tested.expect_right(body, i % 2 == 0 ? kInfinity : random.log_uniform(1e-3, 3.0));
      if (HasFailure()) return;
    }
  }
}

TEST(BspTree, AnswersWhereMuchTouchesAndLiesInPlanes) {
  RandomTriangles random(532);
  const Tested tested(scene::mesh_of_triangles(scene::grid_soup(random, 500)), {.threshold = 2});
  for (int i = 0; i < 1500; ++i) {
    const Vec3 at = random.on_grid(14);
    const std::array<Triangle, 2> body = {moved(random.grid_triangle(2), at),
                                          moved(random.grid_triangle(2), at)};
    tested.expect_right(body, i % 2 == 0 ? kInfinity : 1.0 + i % 3);
    if (HasFailure()) return;
  }
}

// Cuts at all angles, edges along planes and thin slivers strain the margin most.
TEST(BspTree, AnswersForSliversFarFromTheOrigin) {
  RandomTriangles random(533);
  const Vec3 far(1e6, -2e6, 5e5);
  std::vector<Triangle> scene;
  for (int i = 0; i < 1500; ++i) {
    scene.push_back(moved(moved(random.thin_triangle(), random.in_cube(8)), far));
  }
  const Tested tested(scene::mesh_of_triangles(scene), {.threshold = 1});
  for (int i = 0; i < 300; ++i) {
    const std::array<Triangle, 1> body = {
        moved(moved(random.thin_triangle(), random.in_cube(8)), far)};
    tested.expect_right(body, kInfinity);
    if (HasFailure()) return;
  }
}

TEST(BspTree, DividesAConvexSurface) {
  constexpr int kRings = 40;
  constexpr int kSectors = 80;
  const auto point = [](int ring, int sector) {
    const double polar = std::numbers::pi * ring / kRings;
    const double around = 2.0 * std::numbers::pi * sector / kSectors;
    return Vec3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                std::cos(polar));
  };
  std::vector<Triangle> ball;
  for (int i = 0; i < kRings; ++i) {
    for (int k = 0; k < kSectors; ++k) {
      ball.push_back({point(i, k), point(i + 1, k), point(i + 1, k + 1)});
      ball.push_back({point(i, k), point(i + 1, k + 1), point(i, k + 1)});
    }
  }
  const Tested tested(scene::mesh_of_triangles(ball));
  EXPECT_GT(tested.tree().leaves(), 100U);
  RandomTriangles random(534);
  for (int i = 0; i < 100; ++i) {
    const Vec3 at = random.in_cube(1.5);
    tested.expect_right(std::array<Triangle, 1>{Triangle{at, at + random.in_cube(0.1), at}},
                        kInfinity);
  }
}

TEST(BspTree, StaysBoundedWhereNoPlaneSeparates) {
  RandomTriangles random(535);
  const Vec3 p(1e6, -1e6, 3.0);
  const Triangle one = {Vec3(0, 0, 0), Vec3(3, 1, 0), Vec3(1, 4, 2)};
  std::vector<Triangle> fan;
  for (int i = 0; i < 5000; ++i) {
    const double a = 2.0 * std::numbers::pi * i / 5000;
    const double b = 2.0 * std::numbers::pi * (i + 1) / 5000;
    fan.push_back({Vec3(0, 0, 1), Vec3(std::cos(a), std::sin(a), 0.3 * std::sin(7 * a)),
                   Vec3(std::cos(b), std::sin(b), 0.3 * std::sin(7 * b))});
  }
  for (const std::vector<Triangle>& scene :
       {std::vector<Triangle>(5000, {p, p, p}), std::vector<Triangle>(5000, one), fan}) {
    const Tested tested(scene::mesh_of_triangles(scene));
    for (int i = 0; i < 20; ++i) {
      const Vec3 at = random.in_cube(2.0);
      tested.expect_right(std::array<Triangle, 1>{Triangle{at, at + random.in_cube(0.3), at}},
                          kInfinity);
    }
    tested.expect_right(std::array<Triangle, 1>{scene[7]}, kInfinity);
  }
}

TEST(BspTree, OfNothingAnswersNothing) {
  const BspTree tree(std::make_shared<const Mesh>());
  const std::array<Triangle, 1> body = {Triangle{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}};
  EXPECT_FALSE(tree.nearest(body, kInfinity));
  EXPECT_FALSE(tree.any_within(body, kInfinity));
  EXPECT_FALSE(tree.touches(body));
}

}  // namespace
}  // namespace camway::bench
