// SPDX-License-Identifier: MIT
#include "daemon/correction/path/free_space.h"

#include <gtest/gtest.h>

#include "daemon/scene/snapshot/snapshot.h"
#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using namespace testing_search;  // NOLINT: the fixture of this file

Vec3 anywhere(testing::Random& random, double size_m) {
  std::uniform_real_distribution<double> place(-size_m, size_m);
  const double x = place(random);
  const double y = place(random);
  const double z = place(random);
  return {x, y, z};
}

motion::Pose any_pose(testing::Random& random) {
  const Vec3 position = anywhere(random, 1.2);
  return {position, random.rotation()};
}

// Rounding of distances of a few metres.
const double kDistanceRounding_m = geometry::triangle_distance_error_m(8.0);

TEST(FreeSpace, TheBallHoldsTheBodyInEveryOrientation) {
  testing::Random random(1);
  for (const motion::Body& body :
       {motion::Body(testing::small_camera()), sphere(0.3),
        *motion::Body::make(motion::BoxShape{Vec3(0.5, 0, 0), Vec3(0.3, 0.2, 0.1)}),
        *motion::Body::make(motion::ConvexShape{{{Vec3(1, 2, 3)}, {Vec3(1, 2, 4)}}})}) {
    const SearchScene scene({}, body);
    const FreeSpace space = scene.space();
    for (int run = 0; run < 20; ++run) {
      const motion::Pose pose = any_pose(random);
      const Vec3 center_W = space.center_W(pose);
      EXPECT_LT((space.pose_around(center_W, pose.orientation).position - pose.position).norm(),
                1e-14);
      for (const Triangle& part : body.triangles_C()) {
        for (const Vec3& vertex : part) {
          const double reach_m = (pose.position + pose.orientation * vertex - center_W).norm();
          EXPECT_LE(reach_m + body.ball_radius_m(), space.ball_radius_m() + 1e-14);
        }
      }
    }
  }
}

TEST(FreeSpace, KnowsOfPosesWhatAskingEveryTriangleTells) {
  testing::Random random(2);
  for (const double clearance_m : {0.0, 0.05}) {
    SearchScene scene(testing::scattered_triangles(random, 60, 0.3));
    scene.detect.clearance_m = clearance_m;
    FreeSpace space = scene.space();
    int free = 0;
    for (int run = 0; run < 500; ++run) {
      const motion::Pose pose = any_pose(random);
      const double gap_m = scene.distance_m(pose) - clearance_m;
      for (const double margin_m : {0.0, 0.03}) {
        if (space.is_free(pose, margin_m)) {
          ++free;
          EXPECT_GT(gap_m, margin_m - kDistanceRounding_m);
        } else {
          EXPECT_LT(gap_m, margin_m + 1e-9);  // all that rounding may cost is a trillionth of that
        }
      }
      const double told_m = space.gap_m(pose, 0.1);
      if (gap_m > 1e-9) {
        EXPECT_NEAR(told_m, std::min(gap_m, 0.1), 1e-9);
      } else {
        EXPECT_LE(told_m, 1e-9);
      }
    }
    EXPECT_GT(free, 300);
    EXPECT_LT(free, 970);
  }
}

// Up to the first hit every sample keeps its distance. At the hit the body is as near as the search
// resolves.
TEST(FreeSpace, FirstHitIsTheFirst) {
  constexpr double kMargin_m = 0.01;
  constexpr double kStep_m = 2e-3;
  testing::Random random(3);
  SearchScene scene(testing::scattered_triangles(random, 40, 0.3));
  scene.detect.clearance_m = 0.02;
  FreeSpace space = scene.space();
  const double keep_m = scene.detect.clearance_m + kMargin_m;
  int hits = 0;
  for (int run = 0; run < 60; ++run) {
    const SignedPose from = motion::signed_pose(any_pose(random));
    SignedPose to = motion::signed_pose(any_pose(random));
    if (from.orientation.dot(to.orientation) < 0.0) to.orientation = -to.orientation;
    const std::optional<double> hit = space.first_hit(from, to, kMargin_m);
    EXPECT_EQ(space.passes(from, to, kMargin_m), !hit) << "run " << run;
    const double end = hit.value_or(1.0);
    if (end > 0.0) {
      const SignedPose last = motion::between(from, to, end * (1.0 - 1e-9));
      EXPECT_GE(least_distance_m(scene, space, {from, last}, kStep_m),
                keep_m - kDistanceRounding_m);
    }
    if (!hit) continue;
    ++hits;
    // It is resolved to half of the margin, and a bracket may be two tolerances wide.
    const motion::Pose at = motion::unsigned_pose(motion::between(from, to, *hit));
    EXPECT_LE(scene.distance_m(at), keep_m + kMargin_m);
  }
  EXPECT_GT(hits, 10);
  EXPECT_LT(hits, 60);
}

TEST(FreeSpace, BallsAreToldApartExactlyAndMeasuredAbout) {
  testing::Random random(4);
  const SearchScene scene(testing::scattered_triangles(random, 60, 0.3));
  const FreeSpace space = scene.space();
  int free = 0;
  for (int run = 0; run < 500; ++run) {
    const Vec3 point_W = anywhere(random, 1.2);
    const double radius_m = 0.02 + 0.0004 * run;
    const double gap_m = scene.distance_m(point_W) - radius_m;
    const double told_m = space.ball_gap_m(point_W, radius_m, 0.1);
    if (std::abs(gap_m) < 1e-9) continue;
    EXPECT_EQ(told_m > 0.0, gap_m > 0.0);
    EXPECT_GE(told_m, std::min(gap_m, 0.1) - kDistanceRounding_m);
    EXPECT_LE(told_m, 0.1);
    // The obstacle that is met may be further than the nearest one by a quarter.
    EXPECT_LE(told_m, std::min(0.1, (gap_m + radius_m) / 0.8 - radius_m) + kDistanceRounding_m);
    free += told_m > 0.0 ? 1 : 0;
  }
  EXPECT_GT(free, 50);
  EXPECT_LT(free, 450);
}

// With a distance field the answers are the same, unless they are "far enough".
TEST(FreeSpace, TheDistanceFieldChangesNoAnswerOfABall) {
  testing::Random random(5);
  const scene::SnapshotResult made =
      scene::make_snapshot("scattered", scattered_cuboids(random, 6, 0.5));
  ASSERT_TRUE(made.snapshot);
  const motion::Body body(testing::small_camera());
  const collision::DetectOptions detect;
  const FreeSpace with({collision::Obstacles(*made.snapshot), body, detect});
  const FreeSpace without({collision::Obstacles(made.snapshot->index), body, detect});
  for (int run = 0; run < 500; ++run) {
    const Vec3 point_W = anywhere(random, 1.5);
    EXPECT_EQ(with.ball_gap_m(point_W, 0.1, 0.2), without.ball_gap_m(point_W, 0.1, 0.2));
  }
}

TEST(FreeSpace, DistancesOfPosesCountMovingAndTurning) {
  const SearchScene scene({});
  const FreeSpace space = scene.space();
  const SignedPose a{Vec3::Zero(), Vec4(1, 0, 0, 0)};
  const SignedPose moved{Vec3(3, 4, 0), Vec4(1, 0, 0, 0)};
  EXPECT_DOUBLE_EQ(space.distance_m(a, moved), 5.0);
  const double turn_rad = 0.5;
  const SignedPose turned{Vec3::Zero(), Vec4(std::cos(turn_rad / 2), 0, std::sin(turn_rad / 2), 0)};
  EXPECT_NEAR(space.distance_m(a, turned), space.ball_radius_m() * turn_rad, 1e-14);
  // Signed poses: the same orientation with the other sign is a full turn away.
  EXPECT_NEAR(space.distance_m(a, {a.position, -a.orientation}),
              space.ball_radius_m() * 2.0 * std::numbers::pi, 1e-12);
}

// Bounds and scene are tested together: the nearer one counts.
TEST(FreeSpace, MindsBoundsLikeTheScene) {
  const geometry::Bounds bounds{Vec3(-1, -0.9, -1.1), Vec3(1, 1.2, 0.8)};
  testing::Random random(19);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (const motion::Body& body : {motion::Body(testing::small_camera()), sphere(0.2)}) {
    const SearchScene scene(scattered_cuboids(random, 4, 0.4), body);
    collision::Obstacles obstacles(scene.index);
    const FreeSpace alone = scene.space();
    FreeSpace space({obstacles.within(bounds), scene.body, scene.detect});
    const auto depth_m = [&](const motion::Pose& pose) {
      double least_m = std::numeric_limits<double>::infinity();
      for (const Triangle& part : body.triangles_C()) {
        for (const Vec3& vertex_C : part)
          least_m = std::min(least_m, bounds.depth_m(pose.position + pose.orientation * vertex_C));
      }
      return least_m - body.ball_radius_m();
    };
    for (int run = 0; run < 300; ++run) {
      const motion::Pose pose = any_pose(random);
      const double margin_m = 0.1 * share(random);
      const double truth_m = std::min(scene.distance_m(pose), depth_m(pose));
      EXPECT_EQ(space.is_free(pose, margin_m), truth_m > margin_m) << truth_m - margin_m;
      EXPECT_EQ(space.gap_m(pose, 0.3) > 0.0, truth_m > 0.0) << truth_m;
      if (truth_m > 0.0) {
        EXPECT_NEAR(space.gap_m(pose, 0.3), std::min(truth_m, 0.3), kDistanceRounding_m);
      }
      const auto nearest = space.nearest(pose, 0.5);
      if (depth_m(pose) < 0.5 && depth_m(pose) < 0.8 * scene.distance_m(pose)) {
        ASSERT_TRUE(nearest);
        EXPECT_TRUE(collision::Obstacles::is_side(nearest->triangle));
        EXPECT_NEAR(nearest->distance_m, depth_m(pose), kDistanceRounding_m);
      }
      EXPECT_LE(space.gap_at_least_m(pose), truth_m + kDistanceRounding_m);
      const double ball_m = 0.1;
      const Vec3 other_W = anywhere(random, 1.2);
      EXPECT_EQ(space.ball_gap_m(other_W, ball_m, 0.3) > 0.0,
                alone.ball_gap_m(other_W, ball_m, 0.3) > 0.0 && bounds.depth_m(other_W) > ball_m);
      EXPECT_EQ(space.ball_passes(pose.position, other_W, ball_m),
                alone.ball_passes(pose.position, other_W, ball_m) &&
                    std::min(bounds.depth_m(pose.position), bounds.depth_m(other_W)) > ball_m);
      EXPECT_LE(space.way_gap_m(pose.position, other_W, 1.0), bounds.depth_m(other_W));
      EXPECT_LE(space.way_gap_m(pose.position, other_W, 1.0),
                alone.way_gap_m(pose.position, other_W, 1.0));
    }
  }
}

// Short ways one after another, most of them near what blocked the last one.
TEST(FreeSpace, WhatABallMetBeforeChangesNoAnswer) {
  testing::Random random(21);
  const motion::Body body(testing::small_camera());
  const SearchScene scene(scattered_cuboids(random, 12, 0.4), body);
  const FreeSpace space = scene.space();
  std::optional<std::uint32_t> met;
  Vec3 from_W = anywhere(random, 1.2);
  for (int run = 0; run < 20000; ++run) {
    if (run % 10 == 0) from_W = anywhere(random, 1.2);
    from_W += random.normal_vector(0.01);
    const Vec3 to_W = from_W + random.normal_vector(0.02);
    EXPECT_EQ(space.ball_passes(from_W, to_W, 0.1, met), space.ball_passes(from_W, to_W, 0.1));
  }
}

// The pose moves by as little as possible: along no axis further than the body is beyond, and at
// once to a pose within.
TEST(FreeSpace, BringsPosesWithinBounds) {
  const geometry::Bounds bounds{Vec3(-1, -0.9, -1.1), Vec3(1, 1.2, 0.8)};
  testing::Random random(20);
  constexpr double kMargin_m = 0.05;
  int moved = 0;
  for (const motion::Body& body : {motion::Body(testing::small_camera()), sphere(0.2)}) {
    const SearchScene scene({}, body);
    FreeSpace space({collision::Obstacles(scene.index).within(bounds), scene.body, scene.detect});
    for (int run = 0; run < 300; ++run) {
      const motion::Pose pose = {anywhere(random, 4.0), random.rotation()};
      const motion::Pose inside = space.within_bounds(pose, kMargin_m);
      EXPECT_TRUE(space.is_free(inside, 0.99 * kMargin_m));
      if (inside.position == pose.position) continue;
      ++moved;
      EXPECT_FALSE(space.is_free(pose, kMargin_m));
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (inside.position[axis] == pose.position[axis]) continue;
        motion::Pose less = inside;
        less.position[axis] += 0.01 * (pose.position[axis] < less.position[axis] ? -1.0 : 1.0);
        EXPECT_FALSE(space.is_free(less, kMargin_m));
      }
    }
  }
  EXPECT_GT(moved, 300);
}

// A straight motion may not end nearer to the bounds than the margin, and may not leave them.
TEST(FreeSpace, FindsWhereAMotionLeavesTheBounds) {
  const SearchScene scene({}, sphere(0.2));
  geometry::Bounds bounds;
  bounds.max_W.x() = 1.0;
  FreeSpace space({collision::Obstacles(scene.index).within(bounds), scene.body, scene.detect});
  const auto at = [](double x) { return motion::signed_pose({Vec3(x, 0, 0), Quat::Identity()}); };
  EXPECT_FALSE(space.first_hit(at(-1.0), at(0.7), 0.05));
  const std::optional<double> hit = space.first_hit(at(-1.0), at(1.0), 0.05);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(*hit, 1.75 / 2.0, 0.05);
  EXPECT_LE(*hit, 1.75 / 2.0);
}

}  // namespace
}  // namespace camway::correction
