// SPDX-License-Identifier: MIT
#include "daemon/collision/detect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "daemon/collision/clearance.h"
#include "daemon/collision/near_quad.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::collision {
namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::Corners;
using motion::Keyframe;
using motion::Path;
using scene::Mesh;
using scene::SceneIndex;

Path straight(const Vec3& from, const Vec3& to, const Quat& orientation) {
  return motion::interpolate(
      std::vector<Keyframe>{{0.0, {from, orientation}}, {1.0, {to, orientation}}});
}

std::vector<CollisionInterval> detect(const SceneIndex& index, const Path& path,
                                      const Corners& corners_C, const DetectOptions& options = {}) {
  const std::optional<std::vector<CollisionInterval>> found =
      detect_collisions({Obstacles(index), motion::Body(corners_C), options}, path, path.begin_s(),
                        path.end_s(), base::Deadline::never());
  return found.value_or(std::vector<CollisionInterval>{{-1.0, -1.0}});
}

Mesh plate_at_z0() {
  Mesh mesh;
  testing::add_triangle(mesh, {-50, -50, 0}, {50, -50, 0}, {0, 80, 0});
  return mesh;
}

// A quadrilateral that flies straight through a plane touches it exactly while its foremost and
// rearmost corners are on different sides.
TEST(DetectCollisions, PlaneAtAnyTiltIsBracketedToTheTolerance) {
  const SceneIndex index = SceneIndex::build(plate_at_z0());
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  testing::Random random(11);
  for (int run = 0; run < 200; ++run) {
    const Quat orientation = random.rotation();
    double lowest_m = 1.0;
    double highest_m = -1.0;
    for (const Vec3& corner_C : corners_C) {
      lowest_m = std::min(lowest_m, (orientation * corner_C).z());
      highest_m = std::max(highest_m, (orientation * corner_C).z());
    }
    const Path path = straight({0, 0, 2}, {0, 0, -2}, orientation);
    const std::vector<CollisionInterval> found = detect(index, path, corners_C);
    ASSERT_EQ(found.size(), 1u) << "run " << run;
    // z(t) = 2 - 4t: the foremost corner arrives at t = (2 + lowest) / 4. The speed is 4 m/s, and a
    // bracket may be two tolerances wide: one for the resolution, one for the last stretch.
    const double bracket_s = 2.0 * DetectOptions{}.tolerance_m / 4.0;
    EXPECT_NEAR(found[0].t_begin_s, (2.0 + lowest_m) / 4.0, bracket_s);
    EXPECT_NEAR(found[0].t_end_s, (2.0 + highest_m) / 4.0, bracket_s);
    EXPECT_LE(found[0].t_begin_s, (2.0 + lowest_m) / 4.0);
    EXPECT_GE(found[0].t_end_s, (2.0 + highest_m) / 4.0);
  }
}

// The plate is met for one instant only, so no sampling finds it.
TEST(DetectCollisions, PlateParallelToTheQuadrilateralIsFound) {
  const SceneIndex index = SceneIndex::build(plate_at_z0());
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const Path path = straight({0, 0, 2}, {0, 0, -1.3}, Quat::Identity());
  const std::vector<CollisionInterval> found = detect(index, path, corners_C);
  ASSERT_EQ(found.size(), 1u);
  const double instant_s = (2.0 - 0.1) / 3.3;
  EXPECT_LE(found[0].t_begin_s, instant_s);
  EXPECT_GE(found[0].t_end_s, instant_s);
  EXPECT_LE(found[0].t_end_s - found[0].t_begin_s, 4.0 * DetectOptions{}.tolerance_m / 3.3);
}

TEST(DetectCollisions, ObjectEnclosedByTheSweptTubeIsFound) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-0.005, -0.005, -0.005}, {0.005, 0.005, 0.005});
  const SceneIndex index = SceneIndex::build(mesh);
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const Path path = straight({0, 0, 2}, {0, 0, -2}, Quat::Identity());
  const std::vector<CollisionInterval> found = detect(index, path, corners_C);
  ASSERT_EQ(found.size(), 1u);
  const double bracket_s = 2.0 * DetectOptions{}.tolerance_m / 4.0;
  EXPECT_NEAR(found[0].t_begin_s, (2.0 - 0.1 - 0.005) / 4.0, bracket_s);
  EXPECT_NEAR(found[0].t_end_s, (2.0 - 0.1 + 0.005) / 4.0, bracket_s);
  EXPECT_LE(found[0].t_begin_s, (2.0 - 0.1 - 0.005) / 4.0);
  EXPECT_GE(found[0].t_end_s, (2.0 - 0.1 + 0.005) / 4.0);
}

TEST(DetectCollisions, AClearPassIsFreeDownToTheTolerance) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-1, -1, -1}, {1, 1, 1});
  const SceneIndex index = SceneIndex::build(mesh);
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const double half_height_m = corners_C[0].y();
  const double gap_m = 2.0 * DetectOptions{}.tolerance_m;
  const double eye_y_m = 1.0 + half_height_m + gap_m;
  EXPECT_TRUE(
      detect(index, straight({0, eye_y_m, 3}, {0, eye_y_m, -3}, Quat::Identity()), corners_C)
          .empty());
  const double touching_y_m = 1.0 + half_height_m;
  EXPECT_EQ(detect(index, straight({0, touching_y_m, 3}, {0, touching_y_m, -3}, Quat::Identity()),
                   corners_C)
                .size(),
            1u);
}

// Straight passes beside a triangle, nearer by and nearer by until they touch it.
TEST(RemoveUndecided, LeavesWhatCollidesAndNothingElse) {
  const motion::Body body(motion::near_corners_C(testing::small_camera()));
  testing::Random random(15);
  constexpr double kNearest_m = 1e-6;  // a thousandth of the tolerance
  int undecided = 0;
  for (int run = 0; run < 100; ++run) {
    Mesh mesh;
    testing::add_triangle(mesh, random.in_cube(0.1), random.in_cube(0.1), random.in_cube(0.1));
    const SceneIndex index = SceneIndex::build(mesh);
    const Query query{Obstacles(index), body, {}};
    const Quat orientation = random.rotation();
    const auto collisions = [&](double beside_m) {
      const Path path = straight({-1, beside_m, 0}, {1, beside_m, 0}, orientation);
      std::vector<CollisionInterval> found =
          detect_collisions(query, path, 0.0, 1.0, base::Deadline::never()).value();
      const std::size_t before = found.size();
      remove_undecided(query, path, base::Deadline::never(), found);
      EXPECT_LE(found.size(), before);
      undecided += found.size() < before ? 1 : 0;
      const bool touches =
          path_clearance(query.obstacles, path, body, base::Deadline::never())->lower_bound_m ==
          0.0;
      EXPECT_TRUE(!touches || !found.empty()) << run;
      return found.size();
    };
    double hits_m = 0.0;
    double clear_m = 1.0;
    if (collisions(hits_m) == 0) continue;
    while (clear_m - hits_m > kNearest_m) {
      const double middle_m = 0.5 * (hits_m + clear_m);
      (collisions(middle_m) > 0 ? hits_m : clear_m) = middle_m;
    }
  }
  EXPECT_GT(undecided, 5);
}

TEST(DetectCollisions, SeparateObjectsGiveSeparateIntervalsInOrder) {
  Mesh mesh;
  for (const double z : {1.0, 0.0, -1.0}) {
    testing::add_triangle(mesh, {-50, -50, z}, {50, -50, z}, {0, 80, z});
  }
  const SceneIndex index = SceneIndex::build(mesh);
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const Path path = straight({0, 0, 2}, {0, 0, -2}, Quat::Identity());
  const std::vector<CollisionInterval> found = detect(index, path, corners_C);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_LT(found[0].t_end_s, found[1].t_begin_s);
  EXPECT_LT(found[1].t_end_s, found[2].t_begin_s);
  const FirstCollision first =
      first_collision({Obstacles(index), motion::Body(corners_C)}, path, path.begin_s(),
                      path.end_s(), base::Deadline::never());
  ASSERT_TRUE(first.decided && first.interval);
  EXPECT_EQ(first.interval->t_begin_s, found[0].t_begin_s);
  EXPECT_EQ(first.interval->t_end_s, found[0].t_end_s);
  EXPECT_FALSE(first.interval->witness);
  const FirstCollision later =
      first_collision({Obstacles(index), motion::Body(corners_C)}, path, found[0].t_end_s + 0.01,
                      path.end_s(), base::Deadline::never());
  ASSERT_TRUE(later.decided && later.interval);
  EXPECT_NEAR(later.interval->t_begin_s, found[1].t_begin_s, 1e-4);
}

// All searches walk alike, so they must agree on whether there is a collision, and where the first
// begins.
TEST(AnyCollision, IsFoundExactlyWhereThereIsAFirstOne) {
  testing::Random random(7);
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const motion::Body body(corners_C);
  int colliding = 0;
  for (int run = 0; run < 400; ++run) {
    const bool is_bounded = run % 2 == 1;
    const int triangles = is_bounded ? 4 : 60;
    const SceneIndex index =
        SceneIndex::build(testing::scattered_triangles(random, triangles, 0.15));
    const Path path = straight(random.in_cube(1.2), random.in_cube(1.2), random.rotation());
    Query query{Obstacles(index), body};
    query.options.clearance_m = run % 4 < 2 ? 0.0 : 0.02;
    if (is_bounded) query.obstacles.bounds = {Vec3::Constant(-1.2), Vec3::Constant(1.2)};
    const FirstCollision first = first_collision(query, path, 0.0, 1.0, base::Deadline::never());
    const FirstCollision any = any_collision(query, path, 0.0, 1.0, base::Deadline::never());
    const FirstCollision contact = first_contact(query, path, 0.0, 1.0, base::Deadline::never());
    ASSERT_TRUE(any.decided && contact.decided);
    ASSERT_EQ(contact.interval.has_value(), first.interval.has_value()) << "run " << run;
    if (first.interval) {
      EXPECT_EQ(contact.interval->t_begin_s, first.interval->t_begin_s) << "run " << run;
      EXPECT_LE(contact.interval->t_begin_s, contact.interval->t_end_s) << "run " << run;
    }
    ASSERT_EQ(any.interval.has_value(), first.interval.has_value()) << "run " << run;
    if (!any.interval) continue;
    ++colliding;
    EXPECT_LE(any.interval->t_begin_s, any.interval->t_end_s);
    const double middle_s = 0.5 * (any.interval->t_begin_s + any.interval->t_end_s);
    const motion::Pose middle = path.pose(middle_s);
    bool is_beyond = false;
    for (const Vec3& corner_C : corners_C) {
      const Vec3 corner_W = middle.position + middle.orientation * corner_C;
      is_beyond =
          is_beyond || query.obstacles.bounds.depth_m(corner_W) < DetectOptions{}.tolerance_m;
    }
    // Colliding, or next to the scene or the bounds.
    const double near_m = query.options.clearance_m + DetectOptions{}.tolerance_m;
    EXPECT_TRUE(is_beyond || clearance_m(index, corners_C, middle, near_m)) << "run " << run;
  }
  EXPECT_GT(colliding, 80);
  EXPECT_LT(colliding, 320);
}

TEST(DetectCollisions, IntervalsThatNobodyCouldUseTheGapOfAreJoined) {
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const Path path = straight({0, 0, 2}, {0, 0, -2}, Quat::Identity());
  const double gap_m = DetectOptions{}.joining_distance_m;
  for (const auto& [apart_m, intervals] :
       {std::pair(0.5 * gap_m, 1u), std::pair(2.0 * gap_m, 2u)}) {
    Mesh mesh;
    for (const double z : {0.0, apart_m}) {
      testing::add_triangle(mesh, {-50, -50, z}, {50, -50, z}, {0, 80, z});
    }
    EXPECT_EQ(detect(SceneIndex::build(mesh), path, corners_C).size(), intervals) << apart_m;
  }
}

// The oracle is dense sampling, which may miss a collision but never invents one.
TEST(DetectCollisions, ContainsEverySampledCollisionAndEndsNextToTheScene) {
  testing::Random random(5);
  std::uniform_real_distribution<double> place(-1.2, 1.2);
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const DetectOptions options;
  int colliding_samples = 0;
  for (int run = 0; run < 25; ++run) {
    const SceneIndex index = SceneIndex::build(testing::scattered_triangles(random, 60, 0.15));
    std::vector<Keyframe> keyframes;
    for (int i = 0; i < 5; ++i) {
      keyframes.push_back({static_cast<double>(i),
                           {{place(random), place(random), place(random)}, random.rotation()}});
    }
    const Path path = motion::interpolate(keyframes);
    const std::vector<CollisionInterval> found = detect(index, path, corners_C, options);
    const auto inside = [&](double time_s) {
      return std::any_of(found.begin(), found.end(), [&](const CollisionInterval& interval) {
        return interval.t_begin_s <= time_s && time_s <= interval.t_end_s;
      });
    };
    for (int i = 0; i <= 4000; ++i) {
      const double time_s = 4.0 * i / 4000;
      if (!collides(index, corners_C, path.pose(time_s))) continue;
      ++colliding_samples;
      EXPECT_TRUE(inside(time_s)) << "run " << run << ", t = " << time_s;
    }
    for (const CollisionInterval& interval : found) {
      // At an end the distance from the scene is at most the motion within the undecided stretch.
      for (const double end_s : {interval.t_begin_s, interval.t_end_s}) {
        EXPECT_TRUE(clearance_m(index, corners_C, path.pose(end_s), 3.0 * options.tolerance_m))
            << "run " << run << ", end at " << end_s;
      }
    }
  }
  EXPECT_GT(colliding_samples, 100);
}

TEST(DetectCollisions, IsUndecidedWhenTheDeadlineStrikes) {
  const SceneIndex index = SceneIndex::build(plate_at_z0());
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  const Path path = straight({0, 0, 2}, {0, 0, -2}, Quat::Identity());
  EXPECT_FALSE(detect_collisions({Obstacles(index), motion::Body(corners_C)}, path, 0.0, 1.0,
                                 base::Deadline::after_s(0.0)));
  EXPECT_FALSE(first_collision({Obstacles(index), motion::Body(corners_C)}, path, 0.0, 1.0,
                               base::Deadline::after_s(0.0))
                   .decided);
}

// Up to the instant that the deadline permits, the result equals that of a complete search.
TEST(SearchCollisions, KnowsAllUpToWhereTheDeadlineStruck) {
  Mesh mesh;
  for (int i = 0; i < 4; ++i) testing::add_cuboid(mesh, {-1, -1, i - 0.1}, {1, 1, i + 0.1});
  const SceneIndex index = SceneIndex::build(mesh);
  const motion::Body body(testing::small_camera());
  const Path path = straight({0, 0, 5}, {0, 0, -2}, Quat::Identity());
  const auto all =
      detect_collisions({Obstacles(index), body}, path, 0.0, 1.0, base::Deadline::never());
  ASSERT_EQ(all->size(), 8u);  // two faces each
  double until_s = 0.0;
  std::size_t most = 0;
  for (int looks = 0;; ++looks) {
    const FoundCollisions found = search_collisions({Obstacles(index), body}, path, 0.0, 1.0,
                                                    base::Deadline::after_looks(looks));
    EXPECT_GE(found.until_s, until_s);
    until_s = found.until_s;
    ASSERT_LE(found.collisions.size(), all->size());
    for (std::size_t i = 0; i < all->size(); ++i) {
      const bool is_told = i < found.collisions.size();
      EXPECT_EQ((*all)[i].t_begin_s < until_s, is_told) << looks;
      if (is_told) {
        EXPECT_EQ(found.collisions[i], (*all)[i]) << looks;
      }
    }
    if (!found.complete) most = std::max(most, found.collisions.size());
    if (found.complete) break;
  }
  EXPECT_EQ(until_s, 1.0);
  EXPECT_GT(most, 1u) << "it never struck in between";
}

// No part of a path that cannot be evaluated is free, and the search terminates.
TEST(DetectCollisions, NumbersWithoutMeaningCollideAllOver) {
  const SceneIndex index = SceneIndex::build(plate_at_z0());
  const motion::Body body(testing::small_camera());
  for (const double bad : {std::nan(""), HUGE_VAL, 1e308}) {
    std::vector<motion::Segment> segments(3);
    for (std::size_t i = 0; i < segments.size(); ++i) {
      segments[i].t0_s = static_cast<double>(i);
      segments[i].t1_s = static_cast<double>(i + 1);
      segments[i].position.fill({0, 0, 0.1});
      segments[i].position[2].x() = bad;
      segments[i].orientation.fill({1, 0, 0, 0});
    }
    const auto found = detect_collisions({Obstacles(index), body}, Path(segments), 0.0, 3.0,
                                         base::Deadline::after_s(20.0));
    ASSERT_TRUE(found) << bad;
    ASSERT_EQ(found->size(), 1u) << bad;
    EXPECT_EQ((*found)[0].t_begin_s, 0.0);
    EXPECT_EQ((*found)[0].t_end_s, 3.0);
  }
}

// With orientations of zero length nothing is known of the rotation, on the whole way through a
// plate.
TEST(DetectCollisions, OrientationsThatVanishCollideWhereverTheyCould) {
  const SceneIndex index = SceneIndex::build(plate_at_z0());
  const motion::Body body(testing::small_camera());
  motion::Segment segment;
  segment.t1_s = 1.0;
  for (std::size_t i = 0; i < 4; ++i) {
    segment.position[i] = {0, 0, 2.0 - 4.0 * static_cast<double>(i) / 3.0};
  }
  segment.orientation.fill(geometry::Vec4::Zero());
  const auto found =
      detect_collisions({Obstacles(index), body}, Path(std::vector<motion::Segment>{segment}), 0.0,
                        1.0, base::Deadline::after_s(20.0));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);
  EXPECT_LE((*found)[0].t_begin_s, (2.0 - body.radius_m()) / 4.0);
  EXPECT_GE((*found)[0].t_end_s, (2.0 + body.radius_m()) / 4.0);
  // From three radii away no orientation reaches the plate.
  EXPECT_GE((*found)[0].t_begin_s, (2.0 - 3.1 * body.radius_m()) / 4.0);
}

TEST(DetectCollisions, AnEmptySceneIsFree) {
  const SceneIndex index = SceneIndex::build(Mesh{});
  const Corners corners_C = motion::near_corners_C(testing::small_camera());
  EXPECT_TRUE(detect(index, straight({0, 0, 2}, {0, 0, -2}, Quat::Identity()), corners_C).empty());
}

}  // namespace
}  // namespace camway::collision
