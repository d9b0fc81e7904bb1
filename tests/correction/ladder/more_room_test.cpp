// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/more_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "daemon/collision/clearance.h"
#include "daemon/correction/ladder/rungs.h"
#include "daemon/correction/smoothing/objective_cost.h"
#include "tests/correction/ladder_case.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using base::Deadline;

// Rounding of an angle near 0 from the dot product of unit quaternions: a few roots of epsilon.
constexpr double kAngleRounding_rad = 1e-7;

// Rounding of accelerations of steps of 0.01 s or more between coordinates up to 2: each of the six
// products is off by 24 · epsilon · 2 / 0.01², together 6.4e-10.
constexpr double kJumpRounding = 1e-9;

constexpr double kHalfWidth_m = 0.1;  // of the near quadrilateral of `small_camera()`

double least_gap_m(const LadderCase& c, const motion::CubicPath& path) {
  return collision::path_clearance(c.query().obstacles, path.path(), c.body, Deadline::never())
      ->lower_bound_m;
}

/// Adds a wall at z = 0 that is endless in x and y, but for a door.
void add_wall_with_door(scene::Mesh& mesh, double door_begin_m, double door_end_m) {
  testing::add_cuboid(mesh, {-60, -60, -0.05}, {door_begin_m, 60, 0.05});
  testing::add_cuboid(mesh, {door_end_m, -60, -0.05}, {60, 60, 0.05});
}

// The camera keeps its orientation, so it has most room in the middle of the door.
TEST(MoreRoom, GoesThroughTheMiddleOfADoor) {
  testing::Random random(4531);
  for (int run = 0; run < 30; ++run) {
    const double room_m = random.uniform(0.1, 0.3);  // on either side of the camera
    const double half_m = kHalfWidth_m + room_m;
    const double middle_m = random.uniform(half_m - kHalfWidth_m, 1.0);
    scene::Mesh mesh;
    add_wall_with_door(mesh, middle_m - half_m, middle_m + half_m);
    const LadderCase c = case_with(mesh, {at(0, {0, 0, 2}), at(5, {0, 0, -2})});
    ASSERT_FALSE(c.collisions(c.path()).empty());
    const double closest_m = least_gap_m(c, corrected_for(Objective::kClosest, c).path);
    const LadderResult safest = corrected_for(Objective::kSafest, c);
    const double safest_m = least_gap_m(c, safest.path);
    EXPECT_TRUE(safest.is_polished);
    // Bisection ends within a sixth of the largest gap that is tried, proofs within a tenth.
    EXPECT_GT(safest_m, 0.75 * room_m) << run << ": door of " << 2.0 * half_m << " m";
    EXPECT_LT(safest_m, (1.0 + 1e-9) * room_m) << run;
    EXPECT_GT(safest_m, closest_m) << run;
  }
}

/// The largest jump of velocity or acceleration between two pieces. [Units: m/s or m/s²]
double largest_jump(const motion::CubicPath& path) {
  double jump = 0.0;
  const auto velocity = [](const motion::CubicPiece& piece, std::size_t i) -> geometry::Vec3 {
    return 3.0 / (piece.t1_s - piece.t0_s) * (piece.position[i + 1] - piece.position[i]);
  };
  const auto acceleration = [&](const motion::CubicPiece& piece, std::size_t i) -> geometry::Vec3 {
    return 2.0 / (piece.t1_s - piece.t0_s) * (velocity(piece, i + 1) - velocity(piece, i));
  };
  for (std::size_t i = 0; i + 1 < path.pieces.size(); ++i) {
    const motion::CubicPiece& before = path.pieces[i];
    const motion::CubicPiece& after = path.pieces[i + 1];
    jump = std::max({jump, (velocity(after, 0) - velocity(before, 2)).norm(),
                     (acceleration(after, 0) - acceleration(before, 1)).norm()});
  }
  return jump;
}

// With more room, corrections of one interval reach over its keyframes. The attempts after that
// must not cut them off there: `CorrectedPath::restore` would not allow it.
TEST(MoreRoom, KeepsThePathTwiceDifferentiable) {
  testing::Random random(4534);
  int polished = 0;
  for (int run = 0; run < 150; ++run) {
    scene::Mesh mesh;
    std::vector<motion::Keyframe> keyframes = {
        at(0, {0, random.uniform(-0.1, 0.1), 1.1}),
        at(4, {random.uniform(-0.3, 0.3), random.uniform(-0.1, 0.1), 0}),
        at(8, {random.uniform(0.8, 1.2), random.uniform(-0.3, 0.1), random.uniform(-0.3, 0.3)})};
    for (motion::Keyframe& keyframe : keyframes) {
      keyframe.pose.orientation =
          geometry::Quat(Eigen::AngleAxisd(random.uniform(-2, 2), geometry::Vec3::UnitY()));
    }
    for (int i = 0; i < 10; ++i) {
      const geometry::Vec3 post(random.uniform(-0.4, 1.2), 0, random.uniform(-0.6, 1.1));
      const bool is_beside = std::ranges::all_of(keyframes, [&](const motion::Keyframe& keyframe) {
        const geometry::Vec3 away = keyframe.pose.position - post;
        return std::hypot(away.x(), away.z()) > 0.27;
      });
      if (is_beside) {
        testing::add_cuboid(mesh, post - geometry::Vec3(0.05, 2, 0.05),
                            post + geometry::Vec3(0.05, 2, 0.05));
      }
    }
    const LadderCase c = case_with(mesh, keyframes);
    const LadderResult safest = corrected_for(Objective::kSafest, c);
    polished += safest.is_polished ? 1 : 0;
    EXPECT_LT(largest_jump(safest.path), kJumpRounding) << run;
  }
  EXPECT_GT(polished, 75);
}

// A way round is refused if it leads much farther off than the corrections and the sufficient gap.
TEST(MoreRoom, StaysWithTheShot) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-60, -60, -0.05}, {-0.07, 60, 0.05});
  testing::add_cuboid(mesh, {0.18, -60, -0.05}, {1.5, 60, 0.05});
  testing::add_cuboid(mesh, {4, -60, -0.05}, {60, 60, 0.05});  // beside a wide gate
  LadderCase c = case_with(mesh, {at(0, {0, 0, 2}), at(5, {0, 0, -2})});
  c.options.viewing_distance_m = 3.0;
  const LadderResult safest = corrected_for(Objective::kSafest, c);
  EXPECT_TRUE(c.collisions(safest.path).empty());
  EXPECT_LT(safest.corrections.at(0).moved_m, 1.0);
}

// No path has more room than its keyframes. Beyond a multiple of the body's size, room is no
// better.
TEST(MoreRoom, KeepsMostOfTheRoomOfTheKeyframes) {
  testing::Random random(4532);
  for (int run = 0; run < 10; ++run) {
    const double keyframe_m = random.uniform(0.02, 0.2);
    scene::Mesh mesh;
    testing::add_cuboid(mesh, {-3, -3, -0.2}, {0.0, 3, 0.2});
    // Behind the first keyframe, which looks along -z.
    testing::add_cuboid(mesh, {-3, -3, 1.9 + keyframe_m}, {3, 3, 2.5});
    const LadderCase c = case_with(mesh, {at(0, {0.05, 0, 2}), at(5, {0.05, 0, -2})});
    const LadderResult safest = corrected_for(Objective::kSafest, c);
    const double gap_m = least_gap_m(c, safest.path);
    EXPECT_GT(gap_m, 0.8 * keyframe_m) << run;
    const double sufficient_m = kComfort * FreeSpace(c.query()).ball_radius_m();
    EXPECT_LT(safest.corrections.at(0).moved_m, 2.0 * sufficient_m) << run;
  }
}

// With more clearance, the collisions with the two plates are one.
TEST(MoreRoom, ProgressTellsOfTheCollisionsOfThePath) {
  scene::Mesh mesh;
  for (const double z_m : {-0.15, 0.15}) {
    testing::add_cuboid(mesh, {-3, -3, z_m - 0.01}, {0.0, 3, z_m + 0.01});
  }
  LadderCase c = case_with(mesh, {at(0, {0.05, 0, 2}), at(5, {0.05, 0, -2})});
  c.options.objective = Objective::kSafest;
  const motion::CubicPath path = c.path();
  const std::vector<collision::CollisionInterval> collisions = c.collisions(path);
  ASSERT_EQ(collisions.size(), 2u);
  const auto progress = std::make_shared<base::Progress>();
  const LadderResult safest =
      correct_by_ladder(std::make_shared<const scene::Mesh>(c.mesh), c.query(), c.keyframes, path,
                        collisions, c.options, Deadline::never().watched({}, progress));
  EXPECT_TRUE(safest.is_polished);
  EXPECT_EQ(progress->collisions, 2);
  EXPECT_EQ(progress->corrected, 2);
}

// A camera of 35 by 4 cm has more room in a slot if it is turned.
TEST(MoreRoom, TurnsOnlyWhereTheCorrectionsTurn) {
  testing::Random random(4533);
  int moved = 0;
  for (int run = 0; run < 20; ++run) {
    const double half_m = random.uniform(0.19, 0.215);
    scene::Mesh mesh;
    add_wall_with_door(mesh, -half_m, half_m);
    const double x_m = half_m - 0.175 + random.uniform(0.002, 0.012);
    LadderCase c = case_with(mesh, {at(0, {x_m, 0, 2}), at(5, {x_m, 0, -2})});
    c.body = motion::Body(motion::Camera{2.0 * std::atan(1.75), 2.0 * std::atan(0.2), 0.1});
    c.options.viewing_distance_m = 1.0;  // at which such turns are no reason to refuse the result
    const LadderResult closest = corrected_for(Objective::kClosest, c);
    ASSERT_EQ(closest.corrections.size(), 1u) << run;
    if (closest.corrections[0].turned_rad > kAngleRounding_rad) continue;
    ++moved;
    const LadderResult safest = corrected_for(Objective::kSafest, c);
    EXPECT_LT(safest.corrections[0].turned_rad, kAngleRounding_rad) << run;
  }
  EXPECT_GT(moved, 3);
}

// Attempts correct everything between two keyframes. What a search gave up is not searched again.
TEST(MoreRoom, LeavesIntervalsWithOpenCollisionsAsTheyAre) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-3, -3, 0.9}, {0.0, 3, 1.1});
  testing::add_cuboid(mesh, {-3, -3, -2.6}, {0.0, 3, -2.4});
  const LadderCase c = case_with(mesh, {at(0, {0.05, 0, 2}), at(10, {0.05, 0, -4})});
  const motion::CubicPath interpolated = c.path();
  const Deadline never = Deadline::never();
  const motion::TimeOrigin origin;
  for (const bool all : {true, false}) {
    FreeSpace space(c.query());
    CorrectedPath corrected(interpolated, c.keyframes, {200, 0.0}, never);
    CollisionList collisions(c.collisions(interpolated), corrected.keyframes_s());
    ASSERT_EQ(collisions.size(), 2u);
    Rungs rungs(space, corrected, collisions, origin, /*seed=*/1);
    ASSERT_TRUE(rungs.move_away(0));
    ASSERT_TRUE(!all || rungs.move_away(1));
    EXPECT_EQ(make_more_room(origin, /*seed=*/1, space, corrected, collisions), all);
    EXPECT_EQ(collisions.count_open(), all ? 0u : 1u);
  }
}

}  // namespace
}  // namespace camway::correction
