// SPDX-License-Identifier: MIT
//
// Bodies that leave their bounds, compared with dense sampling, and with the furthest reach along
// an axis that other code proves in extended precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/collision/clearance.h"
#include "daemon/collision/detect.h"
#include "daemon/collision/probe.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/collision/crossing_paths.h"
#include "tests/collision/precise_pose.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::collision {
namespace {

using geometry::Bounds;
using geometry::Quat;
using geometry::Vec3;
using motion::Body;
using motion::Path;
using scene::SceneIndex;

Bounds with_limit(std::size_t side, double limit_m) {
  Bounds bounds;
  const auto axis = static_cast<Eigen::Index>(side % 3);
  (side < 3 ? bounds.min_W : bounds.max_W)[axis] = limit_m;
  return bounds;
}

std::vector<CollisionInterval> detect(const SceneIndex& index, const Bounds& bounds,
                                      const Path& path, const Body& body,
                                      const DetectOptions& options = {}) {
  const auto found = detect_collisions({Obstacles(index).within(bounds), body, options}, path,
                                       path.begin_s(), path.end_s(), base::Deadline::never());
  return found.value();
}

bool holds(const std::vector<CollisionInterval>& intervals, double time_s) {
  return std::ranges::any_of(intervals, [&](const CollisionInterval& interval) {
    return interval.t_begin_s <= time_s && time_s <= interval.t_end_s;
  });
}

// The furthest reach is known to a picometre. A limit beyond it by the resolution of the search is
// kept; a limit just short of it is broken, at the time of the reach.
TEST(BoundsOfAPath, AreKeptToExactlyWhereTheReachIsBelowThem) {
  constexpr std::uint64_t kSeed = 16;
  constexpr testing::Real kSlack_m = 1e-12L;
  const SceneIndex nothing;
  int decided = 0;
  for (std::uint64_t run = 0; run < 60; ++run) {
    testing::Random random = testing::Random::of_case(kSeed, run);
    const Vec3 place_W = testing::random_place(random);
    const motion::Camera camera = testing::random_camera(random);
    const motion::Corners corners_C = motion::near_corners_C(camera);
    const Body body(corners_C);
    const Path path =
        testing::random_path(random, testing::PathKind::kFree, place_W, 2.0 * body.radius_m());
    DetectOptions options;
    options.tolerance_m = 1e-3 * body.radius_m();
    options.joining_distance_m = 5.0 * options.tolerance_m;
    for (std::size_t side = 0; side < Bounds::kSides; ++side) {
      const testing::RealVec3 outward = -Bounds::inward(side).cast<testing::Real>();
      const auto reach = testing::furthest_reach(path, corners_C, outward, kSlack_m);
      if (!reach) continue;
      ++decided;
      const double sign = side < 3 ? -1.0 : 1.0;
      const double margin_m = 2.0 * options.tolerance_m;
      const double beyond_m = sign * (static_cast<double>(reach->value_m) + margin_m);
      EXPECT_TRUE(detect(nothing, with_limit(side, beyond_m), path, body, options).empty())
          << "run " << run << ", " << Bounds::kSideNames[side];
      // Short of it by the resolution of doubles there, and by the oracle's own slack.
      const double resolved_m =
          1e-11 + 4.0 * std::numeric_limits<double>::epsilon() * std::abs(beyond_m);
      const double short_m = sign * (static_cast<double>(reach->reached_m) - resolved_m);
      const auto found = detect(nothing, with_limit(side, short_m), path, body, options);
      const double when_s = path.segments()[reach->segment].t0_s + reach->u;
      EXPECT_TRUE(holds(found, when_s)) << "run " << run << ", " << Bounds::kSideNames[side];
    }
  }
  EXPECT_GT(decided, 200);
}

// The oracle is dense sampling, for bodies of all kinds: every sample outside of the bounds lies in
// an interval, and at the ends of intervals the body is near its bounds.
TEST(BoundsOfAPath, HoldEverySampleThatIsInNoInterval) {
  testing::Random random(5);
  std::uniform_real_distribution<double> place(-1.2, 1.2);
  const std::vector<Body> bodies = {
      Body(testing::small_camera()), *Body::make(motion::SphereShape{Vec3(0.1, 0, 0), 0.2}),
      *Body::make(motion::BoxShape{Vec3(0, 0, 0.1), Vec3(0.3, 0.2, 0.1)})};
  const SceneIndex nothing;
  const DetectOptions options;
  int outside_samples = 0;
  int inside_samples = 0;
  for (int run = 0; run < 30; ++run) {
    const Body& body = bodies[static_cast<std::size_t>(run) % bodies.size()];
    std::vector<motion::Keyframe> keyframes;
    for (int i = 0; i < 4; ++i) {
      keyframes.push_back({static_cast<double>(i),
                           {{place(random), place(random), place(random)}, random.rotation()}});
    }
    const Path path = motion::interpolate(keyframes);
    const Bounds bounds{Vec3(-1, -0.9, -0.8), Vec3(0.9, 1, 0.8)};
    const auto depth_m = [&](double time_s) {
      const motion::Pose pose = path.pose(time_s);
      double least_m = std::numeric_limits<double>::infinity();
      for (const geometry::Triangle& part : body.triangles_C()) {
        for (const Vec3& vertex_C : part)
          least_m = std::min(least_m, bounds.depth_m(pose.position + pose.orientation * vertex_C));
      }
      return least_m - body.ball_radius_m();
    };
    const std::vector<CollisionInterval> found = detect(nothing, bounds, path, body, options);
    for (int i = 0; i <= 3000; ++i) {
      const double time_s = 3.0 * i / 3000;
      const bool is_outside = depth_m(time_s) <= 0.0;
      ++(is_outside ? outside_samples : inside_samples);
      if (is_outside) {
        EXPECT_TRUE(holds(found, time_s)) << "run " << run << ", t = " << time_s;
      }
    }
    for (const CollisionInterval& interval : found) {
      EXPECT_TRUE(interval.witness && Obstacles::is_side(interval.witness->triangle));
      for (const double end_s : {interval.t_begin_s, interval.t_end_s}) {
        EXPECT_LE(depth_m(end_s), 3.0 * options.tolerance_m) << "run " << run;
      }
    }
  }
  EXPECT_GT(outside_samples, 5000);
  EXPECT_GT(inside_samples, 5000);
}

// Intervals count the nearer of scene and bounds; the clearance counts the scene only.
TEST(BoundsOfAPath, AddToWhatTheSceneAsks) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-0.5, -0.5, -0.1}, {0.5, 0.5, 0.1});
  const SceneIndex index = SceneIndex::build(mesh);
  const Body body(testing::small_camera());
  const Path path = motion::interpolate(std::vector<motion::Keyframe>{
      {0.0, {Vec3(0, 0, 3), Quat::Identity()}}, {6.0, {Vec3(0, 0, -3), Quat::Identity()}}});
  const auto alone = detect(index, {}, path, body);
  ASSERT_EQ(alone.size(), 2u);  // the two faces: what is inside touches nothing
  const auto both = detect(index, with_limit(2, -2.0), path, body);
  ASSERT_EQ(both.size(), 3u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(both[i].t_begin_s, alone[i].t_begin_s, 2.0 * DetectOptions{}.tolerance_m);
    EXPECT_NEAR(both[i].t_end_s, alone[i].t_end_s, 2.0 * DetectOptions{}.tolerance_m);
  }
  EXPECT_EQ(Obstacles::side_of(both[2].witness->triangle), 2u);
  // The plane of the quadrilateral is 0.1 m in front of the eye.
  EXPECT_NEAR(both[2].t_begin_s, 3.0 + 2.0 - 0.1, 3e-3);
  EXPECT_EQ(both[2].t_end_s, 6.0);
  EXPECT_EQ(both[2].witness->point_W.z(), -2.0);

  const Path aside = motion::interpolate(std::vector<motion::Keyframe>{
      {0.0, {Vec3(2, 0, 3), Quat::Identity()}}, {6.0, {Vec3(2, 0, -3), Quat::Identity()}}});
  const Obstacles near_bounds = Obstacles(index).within(with_limit(3, 2.2));
  const auto with = path_clearance(near_bounds, aside, body, base::Deadline::never());
  const auto without = path_clearance(Obstacles(index), aside, body, base::Deadline::never());
  EXPECT_EQ(with->lower_bound_m, without->lower_bound_m);
  EXPECT_GT(with->lower_bound_m, 1.0);
}

TEST(BoundsOfAPath, CountWithoutAScene) {
  const Body body(testing::small_camera());
  const Path path = motion::interpolate(std::vector<motion::Keyframe>{
      {0.0, {Vec3(0, 0, 0), Quat::Identity()}}, {1.0, {Vec3(100, 0, 0), Quat::Identity()}}});
  const auto found = detect(SceneIndex(), with_limit(3, 50.0), path, body);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LE(found[0].t_begin_s, 0.499);
  EXPECT_GE(found[0].t_begin_s, 0.499 - 1e-4);
  EXPECT_EQ(found[0].t_end_s, 1.0);
  // The foremost corner along x is half of the quadrilateral's width, 0.1 m, from the eye.
  const Witness& witness = *found[0].witness;
  EXPECT_NEAR(witness.depth_m, 100.0 * witness.time_s + 0.1 - 50.0, 1e-9);
}

TEST(BoundsOfAPath, NumbersWithoutMeaningLeaveThem) {
  const Body body(testing::small_camera());
  for (const double bad : {std::nan(""), HUGE_VAL, 1e308}) {
    motion::Segment segment;
    segment.t1_s = 1.0;
    segment.position.fill({0, 0, 0.1});
    segment.position[2].x() = bad;
    segment.orientation.fill({1, 0, 0, 0});
    const auto found = detect(SceneIndex(), with_limit(1, -1.0),
                              Path(std::vector<motion::Segment>{segment}), body);
    ASSERT_EQ(found.size(), 1u) << bad;
    EXPECT_EQ(found[0].t_begin_s, 0.0);
    EXPECT_EQ(found[0].t_end_s, 1.0);
  }
}

}  // namespace
}  // namespace camway::collision
