// SPDX-License-Identifier: MIT
//
// Searches with a body that has a tree, against loops over all pairs of triangles.
#include "daemon/scene/index/tree_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "daemon/geometry/winding.h"
#include "tests/scene/index/index_oracle.h"
#include "tests/scene/test_meshes.h"
#include "tests/support/body_meshes.h"

namespace camway::scene {
namespace {

using geometry::Triangle;
using geometry::TriangleTree;
using geometry::Vec3;

/// A body and a scene, near each other or not.
class TreeCase {
 public:
  explicit TreeCase(geometry::RandomTriangles& random)
      : random_(random),
        index_(make_scene()),
        triangles_C_(make_body()),
        tree_(triangles_C_),
        body_(tree_, triangles_C_) {}

  void place(bool is_moving) {
    BodyMotion motion{random_.rotation().toRotationMatrix(), random_.in_cube(6.0)};
    body_.place(motion);
    if (!is_moving) return;
    // Towards the nearest triangle of the scene or away from it, about as far as that is. A turn
    // about the eye moves the nearest triangle of the body the same way.
    const auto [gap_W, part] = nearest_gap();
    const Vec3 way_W = random_.uniform(-1.5, 1.5) * gap_W + random_.in_cube(0.1 * gap_W.norm());
    if (random_.chance(0.5)) {
      motion.eye_step_W = way_W;
    } else {
      const Vec3 arm_W = motion.R_WC * triangles_C_[part][0];
      motion.turn_step_W = arm_W.cross(way_W) / arm_W.squaredNorm();
      motion.turn_step_W *= std::min(1.0, 0.5 / motion.turn_step_W.norm());
    }
    body_.place(motion);
  }

  TreeBody& body() { return body_; }
  const SceneIndex& index() { return index_; }
  [[nodiscard]] std::uint32_t size() const {
    return static_cast<std::uint32_t>(triangles_C_.size());
  }
  /// Distance of a triangle of the body, at the middle of the motion, from one of the scene.
  [[nodiscard]] double distance_m(std::uint32_t number, std::uint32_t triangle) const {
    return geometry::triangle_distance(body_.middle(number), index_.triangle(triangle));
  }
  [[nodiscard]] double least_distance_m() const {
    double least_m = kInfinity;
    for (std::uint32_t i = 0; i < size(); ++i) {
      for (std::uint32_t t = 0; t < index_.size(); ++t)
        least_m = std::min(least_m, distance_m(i, t));
    }
    return least_m;
  }
  /// The shortest way from the body to the scene, and the triangle of the body that it begins at.
  [[nodiscard]] std::pair<Vec3, std::uint32_t> nearest_gap() const {
    double least_m = kInfinity;
    std::pair<Vec3, std::uint32_t> nearest{Vec3::UnitX(), 0};
    for (std::uint32_t i = 0; i < size(); ++i) {
      for (std::uint32_t t = 0; t < index_.size(); ++t) {
        const geometry::TriangleGap gap =
            geometry::triangle_gap(body_.middle(i), index_.triangle(t), kInfinity);
        if (!(gap.distance_m > 0.0 && gap.distance_m < least_m)) continue;
        least_m = gap.distance_m;
        nearest = {least_m * gap.direction.normalized(), i};
      }
    }
    return nearest;
  }
  [[nodiscard]] double radius_m(std::uint32_t number) const {
    double radius_m = 0.0;
    for (const Vec3& v : triangles_C_[number]) radius_m = std::max(radius_m, v.norm());
    return radius_m;
  }

 private:
  SceneIndex make_scene() {
    const int parts = random_.integer(1, 3);
    std::vector<std::shared_ptr<const IndexedMesh>> meshes;
    for (int i = 0; i < parts; ++i) {
      const auto mesh = std::make_shared<const Mesh>(mesh_of_triangles(make_part()));
      IndexOptions options;
      options.threshold = 4;
      meshes.push_back(IndexedMesh::build(mesh, options));
    }
    return SceneIndex::of(meshes);
  }

  std::vector<Triangle> make_part() {
    if (random_.chance(0.2)) return grid_soup(random_, 30);
    if (random_.chance(0.7)) return soup(random_, random_.integer(1, 60));
    // Much finer than the body: the walk then goes down in the body, too.
    std::vector<Triangle> cluster;
    const Vec3 middle = random_.in_cube(3.0);
    for (int i = 0; i < 150; ++i) {
      const Vec3 at = middle + random_.in_cube(0.02);
      cluster.push_back(
          {at + random_.in_cube(1e-3), at + random_.in_cube(1e-3), at + random_.in_cube(1e-3)});
    }
    return cluster;
  }

  /// Slivers and coincident triangles, a plane, a torus, and one far from its eye.
  std::vector<Triangle> make_body() {
    const int kind = random_.integer(0, 3);
    if (kind == 0) {
      std::vector<Triangle> triangles;
      for (int i = 0; i < 60; ++i) {
        triangles.push_back(random_.thin_triangle());
        if (i % 7 == 0) triangles.push_back(triangles.back());
      }
      return triangles;
    }
    const Vec3 away = kind == 3 ? random_.in_cube(20.0) : Vec3::Zero();
    const motion::MeshShape mesh =
        kind == 1
            ? testing::divided_quad({1.5, 1.2, random_.log_uniform(0.05, 2.0)}, 8, 6)
            : testing::torus(random_.uniform(0.2, 2.0), random_.uniform(0.02, 0.2), 9, 5, away);
    std::vector<Triangle> triangles;
    for (const auto& t : mesh.triangles)
      triangles.push_back({mesh.vertices_C[t[0]], mesh.vertices_C[t[1]], mesh.vertices_C[t[2]]});
    return triangles;
  }

  geometry::RandomTriangles& random_;
  SceneIndex index_;
  std::vector<Triangle> triangles_C_;
  TriangleTree tree_;
  TreeBody body_;
};

/// How far a point is outside of a box.
double outside_m(const Vec3& point, const Vec3& low, const Vec3& high) {
  return (low - point).cwiseMax(point - high).maxCoeff();
}

TEST(TreeBody, ItsBoxesHoldBothEndsOfItsTriangles) {
  geometry::RandomTriangles random(8100);
  for (int run = 0; run < 60; ++run) {
    TreeCase c(random);
    c.place(/*is_moving=*/true);
    TreeBody& body = c.body();
    const double rounding_m = body.rounding_m(c.index().bounds());
    std::vector<std::uint32_t> waiting = {TreeBody::kRoot};
    while (!waiting.empty()) {
      const std::uint32_t place = waiting.back();
      waiting.pop_back();
      if (!body.node_at(place).is_leaf()) {
        const std::uint32_t first = body.children_of(place);
        waiting.insert(waiting.end(), {first, first + 1});
      }
      const TreeBody::Placed placed = body.placed(place);
      const auto corner = [](const std::array<double, 4>& a) { return Vec3(a[0], a[1], a[2]); };
      const TriangleTree::Node& node = body.node_at(place);
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        for (const Triangle& end : body.ends(body.tree().order()[i])) {
          for (const Vec3& vertex : end) {
            ASSERT_LE(outside_m(vertex, corner(placed.sides.low_m), corner(placed.sides.high_m)),
                      rounding_m);
            ASSERT_LE(outside_m(body.to_body(vertex), corner(placed.oblique.low_m),
                                corner(placed.oblique.high_m)),
                      rounding_m);
          }
        }
      }
    }
  }
}

TEST(TreeSearch, FindsTheDistanceOfALoopOverAllPairs) {
  geometry::RandomTriangles random(8101);
  int found = 0;
  for (int run = 0; run < 250; ++run) {
    TreeCase c(random);
    c.place(/*is_moving=*/false);
    const double least_m = c.least_distance_m();
    for (const double share : {1.0, 0.8, 0.5}) {
      const double cutoff_m = random.chance(0.3) ? kInfinity : random.log_uniform(1e-3, 10.0);
      TreeDistance search(c.body(), c.index().bounds(), cutoff_m, DistanceGoal::kNear, 0.0, share);
      c.index().search(search);
      ASSERT_EQ(search.result().has_value(), least_m < cutoff_m) << "run " << run;
      if (!search.result()) continue;
      ++found;
      EXPECT_EQ(search.result()->distance_m,
                c.distance_m(search.pair()->number, search.pair()->triangle));
      EXPECT_LE(share * search.result()->distance_m, least_m);
    }
    TreeDistance any(c.body(), c.index().bounds(), 0.5, DistanceGoal::kAny);
    c.index().search(any);
    EXPECT_EQ(any.result().has_value(), least_m < 0.5);
  }
  EXPECT_GT(found, 300);
}

TEST(TreeSearch, VisitsAllPairsWithinADistance) {
  geometry::RandomTriangles random(8102);
  std::size_t visited = 0;
  for (int run = 0; run < 150; ++run) {
    TreeCase c(random);
    c.place(/*is_moving=*/false);
    const double within_m = random.chance(0.3) ? 0.0 : random.log_uniform(1e-3, 1.0);
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    const auto visit = [&](std::uint32_t number, std::uint32_t triangle, const Triangle&) {
      pairs.emplace(number, triangle);
      return true;
    };
    TreePairs<decltype(visit)> search(c.body(), c.index().bounds(), within_m, visit);
    c.index().search(search);
    visited += pairs.size();
    for (std::uint32_t i = 0; i < c.size(); ++i) {
      for (std::uint32_t t = 0; t < c.index().size(); ++t) {
        if (pairs.contains({i, t})) continue;
        ASSERT_GT(c.distance_m(i, t), within_m) << "run " << run << ", " << i << ", " << t;
      }
    }
  }
  EXPECT_GT(visited, 500U);
}

// A clear motion promises for each pair: the middle is beyond the reach, or a slab that is
// wider than bend and margin separates both ends, so that all straight lines in between are at
// least that far away.
class ClearMotion {
 public:
  ClearMotion(TreeCase& c, const TreeMargins& margins) : case_(c), margins_(margins) {}

  [[nodiscard]] bool holds(std::uint32_t number, std::uint32_t triangle) const {
    const double radius_m = case_.radius_m(number);
    const double middle_m = case_.distance_m(number, triangle);
    const double error_m =
        geometry::triangle_distance_error_m(case_.body().scale_m(case_.index().bounds()));
    if (middle_m + error_m > margins_.reach.at(radius_m) + margins_.keep_m) return true;
    const std::array<Triangle, 2> ends = case_.body().ends(number);
    constexpr int kSamples = 8;
    for (int s = 0; s <= kSamples; ++s) {
      const double f = static_cast<double>(s) / kSamples;
      Triangle there;
      for (std::size_t k = 0; k < 3; ++k) there[k] = (1.0 - f) * ends[0][k] + f * ends[1][k];
      const double distance_m =
          geometry::triangle_distance(there, case_.index().triangle(triangle));
      if (distance_m + 2.0 * error_m < margins_.bend.at(radius_m) + margins_.keep_m) return false;
    }
    return true;
  }

 private:
  TreeCase& case_;
  TreeMargins margins_;
};

TEST(TreeSearch, AClearMotionKeepsItsDistance) {
  geometry::RandomTriangles random(8103);
  int clear = 0;
  int close = 0;
  for (int run = 0; run < 600; ++run) {
    TreeCase c(random);
    c.place(/*is_moving=*/true);
    const BodyMotion& motion = c.body().motion();
    TreeMargins margins;
    margins.bend = {random.log_uniform(1e-6, 0.02), random.log_uniform(1e-6, 0.02)};
    margins.reach = {margins.bend.at_eye_m + motion.eye_step_W.norm(),
                     margins.bend.per_m + motion.turn_step_W.norm()};
    margins.keep_m = random.log_uniform(1e-6, 0.1);
    TreeSwept search(c.body(), c.index().bounds(), margins);
    c.index().search(search);
    if (!search.result().is_clear) {
      ASSERT_TRUE(search.result().nearest);
      continue;
    }
    ++clear;
    const ClearMotion promise(c, margins);
    for (std::uint32_t i = 0; i < c.size(); ++i) {
      for (std::uint32_t t = 0; t < c.index().size(); ++t)
        ASSERT_TRUE(promise.holds(i, t)) << "run " << run << ", " << i << ", " << t;
    }
    if (c.least_distance_m() < margins.reach.at(c.body().tree().nodes()[0].radius_m)) ++close;
  }
  EXPECT_GT(clear, 100);
  EXPECT_GT(close, 5) << "motions that only their direction proves clear";
}

// A motion that the body's triangles one by one are clear of is proved clear: the boxes lose
// nothing.
TEST(TreeSearch, ProvesWhatTheFlatSearchProves) {
  geometry::RandomTriangles random(8104);
  int both = 0;
  int flat_alone = 0;
  for (int run = 0; run < 400; ++run) {
    TreeCase c(random);
    c.place(/*is_moving=*/true);
    const BodyMotion& motion = c.body().motion();
    const double bend_m = random.log_uniform(1e-6, 0.02);
    const double radius_m = c.body().tree().nodes()[0].radius_m;
    const double reach_m = bend_m + motion.eye_step_W.norm() + radius_m * motion.turn_step_W.norm();
    std::vector<Triangle> middle, ends;
    for (std::uint32_t i = 0; i < c.size(); ++i) {
      middle.push_back(c.body().middle(i));
      for (const Triangle& end : c.body().ends(i)) ends.push_back(end);
    }
    if (!c.index().swept({middle, ends, bend_m, reach_m, 1e-3}).is_clear) continue;
    TreeSwept search(c.body(), c.index().bounds(), {{bend_m, 0.0}, {reach_m, 0.0}, 1e-3});
    c.index().search(search);
    ++(search.result().is_clear ? both : flat_alone);
  }
  EXPECT_GT(both, 100);
  EXPECT_LE(flat_alone, both / 20);
}

// Triangles in and about the tube of a torus that touch no face of it.
TEST(TreeSearch, TellsWhetherATriangleIsInside) {
  geometry::RandomTriangles random(8105);
  std::vector<Triangle> torus;
  const motion::MeshShape mesh = testing::torus(1.0, 0.3, 40, 20);
  for (const auto& t : mesh.triangles)
    torus.push_back({mesh.vertices_C[t[0]], mesh.vertices_C[t[1]], mesh.vertices_C[t[2]]});
  const TriangleTree tree(torus);
  int inside = 0;
  int outside = 0;
  for (int run = 0; run < 300; ++run) {
    const BodyMotion place{random.rotation().toRotationMatrix(), random.in_cube(100.0)};
    const auto is_inside = [&](const Vec3& point_W) {
      const Vec3 point_C = place.R_WC.transpose() * (point_W - place.eye_W);
      return geometry::winding_number(point_C, torus, tree) != 0;
    };
    std::vector<Triangle> scene;
    bool any = false;
    while (scene.size() < 40) {
      const Vec3 at_C = random.in_cube(1.3);
      const double ring_m = std::hypot(at_C.x(), at_C.y()) - 1.0;
      const double away_m = std::hypot(ring_m, at_C.z());
      if (std::abs(away_m - 0.3) < 0.06) continue;
      // At most one in a scene is inside.
      if (away_m < 0.3 && (any || random.chance(0.95))) continue;
      any = any || away_m < 0.3;
      const Vec3 at_W = place.R_WC * at_C + place.eye_W;
      scene.push_back(
          {at_W + random.in_cube(0.02), at_W + random.in_cube(0.02), at_W + random.in_cube(0.02)});
    }
    std::ranges::shuffle(scene, random);
    const SceneIndex index = SceneIndex::build(mesh_of_triangles(scene));
    TreeBody body(tree, torus);
    body.place(place);
    ASSERT_EQ(index.has_inside(body, is_inside), any) << "run " << run;
    ++(any ? inside : outside);
  }
  EXPECT_GT(inside, 50);
  EXPECT_GT(outside, 50);
}

}  // namespace
}  // namespace camway::scene
