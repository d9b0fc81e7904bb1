// SPDX-License-Identifier: MIT
//
// Bodies of many triangles: against loops over their vertices, and against the same shapes of few
// triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "daemon/collision/clearance.h"
#include "daemon/collision/detect.h"
#include "daemon/collision/tree_queries.h"
#include "daemon/collision/witness.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/motion/random_motion.h"
#include "tests/support/body_meshes.h"
#include "tests/support/random.h"
#include "tests/support/sanitizer.h"
#include "tests/support/scenes.h"

namespace camway::collision {
namespace {

using geometry::Quat;
using geometry::Triangle;
using geometry::Vec3;
using motion::Body;
using motion::Keyframe;
using motion::Path;
using motion::Stretch;
using scene::SceneIndex;

Body many(const motion::MeshShape& mesh) {
  base::Result<Body> body = Body::make(mesh);
  EXPECT_TRUE(body) << body.error;
  return *std::move(body.value);
}

motion::MeshShape solid(motion::MeshShape mesh) {
  mesh.solid = true;
  return mesh;
}

Path random_path(testing::Random& random, double scale_m) {
  return motion::interpolate(
      motion::test::with_times(motion::test::random_poses(random, 4, scale_m)));
}

Path straight_path(const Vec3& from, const Vec3& to) {
  return motion::interpolate(
      std::vector<Keyframe>{{0.0, {from, Quat::Identity()}}, {1.0, {to, Quat::Identity()}}});
}

std::vector<CollisionInterval> intervals(const SceneIndex& index, const Path& path,
                                         const Body& body, const DetectOptions& options = {},
                                         const geometry::Bounds& bounds = {}) {
  return detect_collisions({Obstacles(index).within(bounds), body, options}, path, path.begin_s(),
                           path.end_s(), base::Deadline::never())
      .value();
}

/// Expects intervals that differ by what the resolution of their ends allows.
void expect_similar(const std::vector<CollisionInterval>& a,
                    const std::vector<CollisionInterval>& b, double within_s) {
  const auto covers = [&](const std::vector<CollisionInterval>& all, double time_s) {
    return std::ranges::any_of(all, [&](const CollisionInterval& i) {
      return time_s >= i.t_begin_s - within_s && time_s <= i.t_end_s + within_s;
    });
  };
  for (const auto& [from, in] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const CollisionInterval& interval : *from) {
      if (interval.t_end_s - interval.t_begin_s < 2.0 * within_s) continue;
      EXPECT_TRUE(covers(*in, interval.t_begin_s)) << interval.t_begin_s;
      EXPECT_TRUE(covers(*in, interval.t_end_s)) << interval.t_end_s;
      EXPECT_TRUE(covers(*in, 0.5 * (interval.t_begin_s + interval.t_end_s)));
    }
  }
}

// The near quadrilateral in many triangles is the same set of points.
TEST(TreeBodies, ADividedQuadCollidesWhereTheCameraDoes) {
  testing::Random random(9001);
  const motion::Camera camera = testing::small_camera();
  const Body few(camera);
  const Body body = many(testing::divided_quad(camera, 30, 17));
  ASSERT_NE(body.tree(), nullptr);
  std::size_t found = 0;
  for (int run = 0; run < 20; ++run) {
    const SceneIndex index =
        SceneIndex::build(testing::scattered_triangles(random, 150, random.uniform(0.05, 0.4)));
    const Path path = random_path(random, 0.8);
    DetectOptions options;
    options.clearance_m = run % 3 == 0 ? 0.02 : 0.0;
    const auto expected = intervals(index, path, few, options);
    const auto seen = intervals(index, path, body, options);
    found += expected.size();
    // The slowest point of a touch: intervals are joined, and their ends bracketed, by distances.
    expect_similar(expected, seen, 0.02 * (path.end_s() - path.begin_s()));
    const auto few_clear = path_clearance(Obstacles(index), path, few, base::Deadline::never());
    const auto clear = path_clearance(Obstacles(index), path, body, base::Deadline::never());
    EXPECT_LE(clear->lower_bound_m, few_clear->upper_bound_m);
    EXPECT_LE(few_clear->lower_bound_m, clear->upper_bound_m);
  }
  EXPECT_GT(found, 40U);
}

// Poses between the intervals are free of each pair of triangles.
TEST(TreeBodies, WhatIsNotReportedIsFree) {
  testing::Random random(9002);
  int free = 0;
  for (int run = 0; run < 12; ++run) {
    const SceneIndex index = SceneIndex::build(testing::scattered_triangles(random, 60, 0.3));
    const Body body = many(testing::torus(0.3, 0.03, 16, 8, random.in_cube(0.3)));
    const Path path = random_path(random, 1.0);
    const auto found = intervals(index, path, body);
    for (int s = 0; s <= 200; ++s) {
      const double time_s =
          std::min(path.end_s(), path.begin_s() + (path.end_s() - path.begin_s()) * s / 200.0);
      const bool is_reported = std::ranges::any_of(found, [&](const CollisionInterval& i) {
        return time_s >= i.t_begin_s && time_s <= i.t_end_s;
      });
      if (is_reported) continue;
      ++free;
      const motion::Pose pose = path.pose(time_s);
      for (const Triangle& part_C : body.triangles_C()) {
        Triangle part;
        for (std::size_t k = 0; k < 3; ++k) part[k] = pose.orientation * part_C[k] + pose.position;
        ASSERT_FALSE(index.intersects(part)) << "run " << run << " at " << time_s;
      }
    }
  }
  EXPECT_GT(free, 300);
}

TEST(TreeBodies, DepthsInsideBoundsAreThoseOfAllVertices) {
  testing::Random random(9003);
  const SceneIndex index;
  for (int run = 0; run < 200; ++run) {
    const Body body = many(testing::torus(random.log_uniform(0.1, 10.0), 0.05, 9, 6,
                                          random.in_cube(random.log_uniform(0.01, 10.0))));
    geometry::Bounds bounds;
    for (int k = 0; k < 3; ++k) {
      if (random.chance(0.7)) bounds.min_W[k] = random.uniform(-9.0, 0.0);
      if (random.chance(0.7)) bounds.max_W[k] = random.uniform(0.0, 9.0);
    }
    if (!bounds.any()) continue;
    TreeQueries queries(Obstacles(index).within(bounds), body);
    Stretch stretch = motion::standing_at({random.in_cube(5.0), random.rotation()});
    stretch.eye_step_W = random.in_cube(0.3);
    stretch.turn_step_W = random.in_cube(0.2);
    queries.move(stretch, random.chance(0.5));
    scene::TreeBody placed(*body.tree(), body.triangles_C());
    Depths least;
    const Depths seen = queries.least_depths();
    const auto depth_m = [&](const Triangle& t) {
      return std::min({bounds.depth_m(t[0]), bounds.depth_m(t[1]), bounds.depth_m(t[2])});
    };
    for (const double sense : {1.0, -1.0}) {
      placed.place(
          {stretch.R_WC, stretch.eye_W, sense * stretch.eye_step_W, sense * stretch.turn_step_W});
      least = {};
      for (std::uint32_t i = 0; i < placed.size(); ++i) {
        least.middle_m = std::min(least.middle_m, depth_m(placed.middle(i)));
        least.first_m = std::min(least.first_m, depth_m(placed.ends(i)[0]));
        least.last_m = std::min(least.last_m, depth_m(placed.ends(i)[1]));
      }
      if (least.first_m == seen.first_m) break;
    }
    EXPECT_EQ(seen.middle_m, least.middle_m);
    EXPECT_EQ(seen.first_m, least.first_m);
    EXPECT_EQ(seen.last_m, least.last_m);
    EXPECT_EQ(queries.least_deep_vertex().gap_m, least.middle_m);
    geometry::Box box;
    for (std::uint32_t i = 0; i < placed.size(); ++i)
      box.extend(geometry::bounds(placed.middle(i)));
    EXPECT_EQ(queries.vertex_box().min(), box.min());
    EXPECT_EQ(queries.vertex_box().max(), box.max());
  }
}

// A cube of 2 cm in the tube of a torus touches no face of it.
class SolidTorus : public ::testing::Test {
 protected:
  static SceneIndex cube_at(const Vec3& center) {
    scene::Mesh mesh;
    testing::add_cuboid(mesh, center - Vec3::Constant(0.01), center + Vec3::Constant(0.01));
    return SceneIndex::build(mesh);
  }
  const motion::MeshShape mesh_ = testing::torus(1.0, 0.2, 40, 20);
  const Body surface_ = many(mesh_);
  const Body solid_ = many(solid(mesh_));
};

TEST_F(SolidTorus, CollidesWithWhatIsInsideIt) {
  const Path still = straight_path({0, 0, 0}, {0, 0, 0.02});
  const SceneIndex inside = cube_at({1.0, 0, 0});
  EXPECT_TRUE(intervals(inside, still, surface_).empty()) << "a surface has no inside";
  const auto found = intervals(inside, still, solid_);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].t_begin_s, 0.0);
  EXPECT_EQ(found[0].t_end_s, 1.0);
  ASSERT_TRUE(found[0].witness);
  EXPECT_NEAR(found[0].witness->depth_m, 0.2, 0.03);
  EXPECT_EQ(
      path_clearance(Obstacles(inside), still, solid_, base::Deadline::never())->lower_bound_m,
      0.0);
}

TEST_F(SolidTorus, DoesNotCollideWithWhatIsInItsHole) {
  const Path still = straight_path({0, 0, 0}, {0, 0, 0.02});
  EXPECT_TRUE(intervals(cube_at({0, 0, 0}), still, solid_).empty());
  EXPECT_TRUE(intervals(cube_at({0.7, 0, 0}), still, solid_).empty());
  // Threading a rod all the way.
  const Path through = straight_path({0.1, 0.1, -3}, {-0.1, 0.1, 3});
  EXPECT_TRUE(intervals(cube_at({0, 0, 0}), through, solid_).empty());
}

TEST_F(SolidTorus, AMotionInAndOutIsOneInterval) {
  const SceneIndex cube = cube_at({0, 0, 0});
  // The tube passes the cube: its surface twice, its inside in between.
  const Path past = straight_path({0, 0, 0}, {-2.0, 0, 0});
  const auto surface = intervals(cube, past, surface_);
  const auto found = intervals(cube, past, solid_);
  ASSERT_EQ(surface.size(), 2U);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].t_begin_s, surface[0].t_begin_s, 2e-3);
  EXPECT_NEAR(found[0].t_end_s, surface[1].t_end_s, 2e-3);
}

// A solid box as a mesh is the box.
TEST(TreeBodies, ASolidMeshCollidesWhereTheSameBoxDoes) {
  testing::Random random(9004);
  const motion::BoxShape box{{0.05, -0.02, 0.1}, {0.5, 0.4, 0.3}};
  const Body few = *Body::make(box);
  motion::MeshShape mesh;
  for (const Triangle& t : few.triangles_C()) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_C.size());
    mesh.vertices_C.insert(mesh.vertices_C.end(), t.begin(), t.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const Body body = many(solid(mesh));
  std::size_t found = 0;
  for (int run = 0; run < 20; ++run) {
    // Most triangles fit inside.
    const SceneIndex index = SceneIndex::build(testing::scattered_triangles(random, 20, 0.03));
    const Path path = random_path(random, 0.8);
    const auto expected = intervals(index, path, few);
    found += expected.size();
    expect_similar(expected, intervals(index, path, body), 0.02 * (path.end_s() - path.begin_s()));
  }
  EXPECT_GT(found, 20U);
}

// 100,000 triangles deep in a crowd of others.
TEST(TreeBodies, LargeBodiesKeepTheDeadline) {
  testing::Random random(9005);
  const SceneIndex index = SceneIndex::build(testing::scattered_triangles(random, 20000, 0.2));
  const Body body = many(testing::torus(0.8, 0.3, 500, 100));
  const Path path = random_path(random, 0.5);
  constexpr double kDeadline_s = 0.05;
  const auto begin = std::chrono::steady_clock::now();
  const FoundCollisions search =
      search_collisions({Obstacles(index), body, {}}, path, path.begin_s(), path.end_s(),
                        base::Deadline::after_s(kDeadline_s));
  const std::chrono::duration<double> took_s = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(took_s.count(), kDeadline_s + (testing::kIsSanitized ? 2.0 : 0.1));
  EXPECT_LE(search.until_s, path.end_s());
}

}  // namespace
}  // namespace camway::collision
