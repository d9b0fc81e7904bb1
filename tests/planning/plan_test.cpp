// SPDX-License-Identifier: MIT
#include "daemon/planning/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <thread>
#include <utility>

#include "daemon/collision/near_quad.h"
#include "daemon/correction/path/viewing_distance.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/planning/plan_fixture.h"
#include "tests/support/body_motion.h"
#include "tests/support/random.h"

namespace camway::planning {
namespace {

using geometry::Quat;
using geometry::Vec3;
using scene::Mesh;
using scene::Snapshot;
using testing_plan::bulging_tour;
using testing_plan::planned;
using testing_plan::snapshot_of;

// Returns a column that the bulging tour grazes.
std::shared_ptr<const Snapshot> column_scene() {
  Mesh mesh;
  testing::add_cuboid(mesh, {0.31, -3, -0.2}, {0.5, 3, 0.0});
  return snapshot_of(std::move(mesh));
}

// Returns every number of the answer except for timing.
std::vector<double> numbers_of(const PlanResult& result) {
  std::vector<double> numbers;
  for (const motion::Segment& segment : result.path.segments()) {
    numbers.insert(numbers.end(), {segment.t0_s, segment.t1_s});
    for (const Vec3& p : segment.position) numbers.insert(numbers.end(), p.begin(), p.end());
    for (const geometry::Vec4& q : segment.orientation)
      numbers.insert(numbers.end(), q.begin(), q.end());
  }
  for (const motion::Keyframe& keyframe : result.keyframes) {
    numbers.push_back(keyframe.time_s);
    numbers.insert(numbers.end(), keyframe.pose.position.begin(), keyframe.pose.position.end());
  }
  for (const auto* list : {&result.collisions, &result.remaining_collisions}) {
    for (const collision::CollisionInterval& interval : *list) {
      numbers.insert(numbers.end(), {interval.t_begin_s, interval.t_end_s});
    }
  }
  return numbers;
}

TEST(Plan, AFreePathIsOkAndUnchanged) {
  const PlanResult result = plan(*snapshot_of(Mesh{}), bulging_tour());
  EXPECT_EQ(result.status, Status::kOk);
  EXPECT_TRUE(result.collisions.empty());
  EXPECT_TRUE(result.remaining_collisions.empty());
  EXPECT_EQ(result.keyframes.size(), 3u);
  EXPECT_EQ(result.path.begin_s(), 0.0);
  EXPECT_EQ(result.path.end_s(), 4.0);
}

TEST(Plan, AGrazingPathIsCorrectedAndTellsWhatCollided) {
  const std::shared_ptr<const Snapshot> snapshot = column_scene();
  const PlanResult result = planned(*snapshot, bulging_tour());
  EXPECT_EQ(result.status, Status::kOk) << result.message;
  EXPECT_EQ(result.collisions.size(), 1u);
  EXPECT_TRUE(result.remaining_collisions.empty());
  EXPECT_GT(result.keyframes.size(), 3u);
  const motion::Corners corners_C = motion::near_corners_C(bulging_tour().camera);
  for (int i = 0; i <= 10'000; ++i) {
    ASSERT_FALSE(
        collision::collides(snapshot->index, corners_C, result.path.pose(4.0 * i / 10'000)));
  }
  EXPECT_TRUE(result.certificate.certified);
  EXPECT_GT(result.certificate.clearance_lower_bound_m, 0.0);
}

TEST(Plan, ALargeWallHeadOnIsGoneRound) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-50, -50, -0.05}, {50, 50, 0.05});
  const PlanResult result = planned(*snapshot_of(std::move(mesh)), bulging_tour());
  EXPECT_EQ(result.status, Status::kOk) << result.message;
  EXPECT_TRUE(result.certificate.certified);
}

double colliding_s(const std::vector<collision::CollisionInterval>& intervals) {
  double sum_s = 0.0;
  for (const auto& interval : intervals) sum_s += interval.t_end_s - interval.t_begin_s;
  return sum_s;
}

TEST(Plan, APartialPathCollidesNoLongerThanTheOneAskedFor) {
  testing::Random random(4);
  std::uniform_real_distribution<double> place(-1.2, 1.2);
  int partial = 0;
  for (int run = 0; run < 40; ++run) {
    const auto snapshot = snapshot_of(testing::scattered_triangles(random, 60, 0.3));
    PlanRequest request = bulging_tour();
    request.has_times = false;
    request.options.method = Method::kKeyframeInsertion;
    for (motion::Keyframe& keyframe : request.keyframes) {
      keyframe.pose = {{place(random), place(random), place(random)}, random.rotation()};
    }
    const PlanResult result = planned(*snapshot, request);
    if (result.status != Status::kPartial) continue;
    ++partial;
    EXPECT_LE(colliding_s(result.remaining_collisions), colliding_s(result.collisions)) << run;
    request.options.method = Method::kLadder;
    EXPECT_EQ(planned(*snapshot, request).status, Status::kOk) << run;
  }
  EXPECT_GT(partial, 10);
}

TEST(Plan, RepairsKeyframesIfAsked) {
  PlanRequest request = bulging_tour();
  request.keyframes[1].pose.position = {0.4, 0, 0.05};  // the quadrilateral is inside the column
  const std::shared_ptr<const Snapshot> snapshot = column_scene();
  const PlanResult refused = planned(*snapshot, request);
  EXPECT_EQ(refused.status, Status::kInvalid);
  ASSERT_EQ(refused.keyframe_faults.size(), 1U);
  EXPECT_EQ(refused.keyframe_faults[0].keyframe, 1U);
  ASSERT_TRUE(refused.keyframe_faults[0].free_pose);
  request.options.repair_keyframes = true;
  const PlanResult repaired = planned(*snapshot, request);
  EXPECT_EQ(repaired.status, Status::kOk) << repaired.message;
  EXPECT_EQ(repaired.path.pose(2.0).position, refused.keyframe_faults[0].free_pose->position);
  for (const motion::Keyframe& keyframe : repaired.keyframes) {
    EXPECT_EQ(keyframe.is_repaired, keyframe.time_s == 2.0);
    if (keyframe.is_repaired) {
      EXPECT_EQ(keyframe.origin, motion::KeyframeOrigin::kGiven);
    }
  }
}

// Half of the second keyframe is in a floor, and the inside of the floor is nearer than the space
// above.
TEST(Plan, RepairsNoKeyframeIntoASolid) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-20, -1, -20}, {20, 0.02, 20});
  const auto snapshot = snapshot_of(std::move(mesh));
  PlanRequest request = bulging_tour();
  for (motion::Keyframe& keyframe : request.keyframes) keyframe.pose.position.y() = 0.5;
  request.keyframes[1].pose.position.y() = 0.0;
  request.options.repair_keyframes = true;
  const PlanResult result = planned(*snapshot, request);
  EXPECT_EQ(result.status, Status::kOk) << result.message;
  EXPECT_GT(result.path.pose(2.0).position.y(), 0.02);
}

// The second of three keyframes is so deep inside that no free pose is near.
TEST(Plan, SaysWhichKeyframeCouldNotBeRepaired) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-20, -1, -20}, {20, 0.02, 20});
  PlanRequest request = bulging_tour();
  for (motion::Keyframe& keyframe : request.keyframes) keyframe.pose.position.y() = 0.5;
  request.keyframes[1].pose.position.y() = 0.0;
  geometry::Vec3& last = request.keyframes[2].pose.position;
  last.z() = -15.0;
  for (int i = -150; i <= 150; ++i) {
    for (const int axis : {0, 1, 2}) {
      geometry::Vec3 half = geometry::Vec3::Constant(3.1);
      half[axis] = 1e-3;
      geometry::Vec3 center = last;
      center[axis] += 0.02 * i;
      testing::add_cuboid(mesh, center - half, center + half);
    }
  }
  request.options.repair_keyframes = true;
  const PlanResult result = planned(*snapshot_of(std::move(mesh)), request);
  EXPECT_EQ(result.status, Status::kInvalid);
  EXPECT_EQ(result.keyframe, 2U);
  EXPECT_THAT(result.message, ::testing::HasSubstr("keyframes[2]"));
  EXPECT_THAT(result.message,
              ::testing::HasSubstr("could not be repaired: no free pose was found near it"));
}

// A correction that moves the camera by less than the tolerance inserts no keyframe, but counts.
TEST(Plan, KeepsCorrectionsOfLessThanTheTolerance) {
  PlanRequest request = bulging_tour();
  request.options.interval_tolerance_m = 1.0;
  const PlanResult result = planned(*column_scene(), request);
  ASSERT_FALSE(result.corrections.empty());
  const bool is_corrected = result.corrections[0].kind != correction::CorrectionKind::kNone;
  EXPECT_EQ(is_corrected, result.measures->largest_deviation_m > 0.0);
  EXPECT_EQ(is_corrected, result.status == Status::kOk) << result.message;
}

TEST(Plan, SaysThatTheToleranceIsCoarseForATinyBody) {
  PlanRequest request = bulging_tour();
  const auto note = ::testing::HasSubstr("options.interval_tolerance_m");
  EXPECT_THAT(plan(*column_scene(), request).message, ::testing::Not(note));
  request.camera.near_m = 1e-3;
  EXPECT_THAT(plan(*column_scene(), request).message, note);
  request.options.interval_tolerance_m = 1e-5;
  EXPECT_THAT(plan(*column_scene(), request).message, ::testing::Not(note));
}

TEST(Plan, MeasuresTheClearanceBeforeAndAfter) {
  PlanRequest request = bulging_tour();
  const PlanResult corrected = planned(*column_scene(), request);
  ASSERT_EQ(corrected.status, Status::kOk);
  EXPECT_EQ(corrected.measures_before->clearance_lower_bound_m, 0.0);
  EXPECT_GT(corrected.measures->clearance_lower_bound_m, 0.0);
  EXPECT_EQ(corrected.measures->clearance_lower_bound_m,
            corrected.certificate.clearance_lower_bound_m);
  request.keyframes[1].pose.position.x() = 0.0;
  const PlanResult free = planned(*column_scene(), request);
  ASSERT_TRUE(free.collisions.empty());
  EXPECT_GT(free.measures_before->clearance_lower_bound_m, 0.0);
  EXPECT_EQ(free.measures_before, free.measures);
}

/// Two walls with doors on different sides, across the way of `bulging_tour`.
std::shared_ptr<const scene::Snapshot> two_doors() {
  Mesh mesh;
  for (const double side : {1.0, -1.0}) {
    const double z_m = 0.8 * side;
    for (const auto& [from_m, to_m] : {std::pair{-6.0, 2.0}, {3.5, 9.0}}) {
      const auto [left_m, right_m] = std::minmax({side * from_m, side * to_m});
      testing::add_cuboid(mesh, {left_m, -8, z_m - 0.05}, {right_m, 8, z_m + 0.05});
    }
  }
  return snapshot_of(std::move(mesh));
}

std::int32_t count_inserted(const PlanResult& result) {
  return static_cast<std::int32_t>(std::ranges::count(
      result.keyframes, motion::KeyframeOrigin::kInserted, &motion::Keyframe::origin));
}

TEST(Plan, SaysHowManyKeyframesWouldBeNeeded) {
  PlanRequest request = bulging_tour();
  ASSERT_GT(count_inserted(planned(*column_scene(), request)), 0);
  request.options.max_inserted_keyframes = 0;
  const PlanResult none = planned(*column_scene(), request);
  EXPECT_EQ(none.status, Status::kPartial);
  EXPECT_THAT(none.message, ::testing::HasSubstr("as options.max_inserted_keyframes asks for"));
  for (const correction::Correction& correction : none.corrections) {
    EXPECT_EQ(correction.tried, correction::Effort{});
  }
  request.keyframes.erase(request.keyframes.begin() + 1);
  request.options.max_inserted_keyframes = 1;
  const PlanResult few = planned(*two_doors(), request);
  EXPECT_EQ(few.status, Status::kPartial);
  EXPECT_THAT(few.message,
              ::testing::ContainsRegex("options.max_inserted_keyframes allows 1, .* need [1-9]"));
}

/// No answer has more inserted keyframes than its limit; the knots count, too, that the
/// interpolation has of its own where the camera turns far. A limit that the unlimited answer keeps
/// does not change it, though more were needed while it was made. A smaller one is told how many
/// that answer has.
TEST(Plan, InsertsNoMoreKeyframesThanAllowed) {
  PlanRequest through_doors = bulging_tour();
  through_doors.keyframes.erase(through_doors.keyframes.begin() + 1);
  PlanRequest turning = bulging_tour();
  turning.body = motion::SphereShape{Vec3::Zero(), 0.15};
  turning.keyframes[1].pose.orientation = Quat(Eigen::AngleAxisd(2.9, Vec3::UnitY()));
  for (auto [snapshot, request] :
       {std::pair{two_doors(), through_doors}, {column_scene(), turning}}) {
    request.options.max_inserted_keyframes = PlanOptions().max_inserted_keyframes;
    const PlanResult unlimited = planned(*snapshot, request);
    ASSERT_EQ(unlimited.status, Status::kOk);
    const std::int32_t needed = count_inserted(unlimited);
    ASSERT_GT(needed, 1);
    for (std::int32_t limit = 1; limit <= needed + 1; ++limit) {
      SCOPED_TRACE(limit);
      request.options.max_inserted_keyframes = limit;
      const PlanResult limited = planned(*snapshot, request);
      EXPECT_LE(count_inserted(limited), limit);
      if (limit < needed) {
        EXPECT_EQ(limited.status, Status::kPartial);
        EXPECT_THAT(limited.message, ::testing::HasSubstr("need " + std::to_string(needed)));
        continue;
      }
      EXPECT_EQ(limited.status, Status::kOk);
      EXPECT_EQ(count_inserted(limited), needed);
      EXPECT_EQ(limited.certificate.clearance_lower_bound_m,
                unlimited.certificate.clearance_lower_bound_m);
    }
  }
}

// A limit that the closest path keeps is no reason to have no path, whatever the objective.
TEST(Plan, HasTheClosestPathWhereAnotherTakesTooManyKeyframes) {
  PlanRequest request = bulging_tour();
  const PlanResult closest = planned(*column_scene(), request);
  ASSERT_EQ(closest.status, Status::kOk);
  request.options.max_inserted_keyframes = count_inserted(closest);
  const std::string limit = std::to_string(count_inserted(closest));
  int closest_taken = 0;
  for (const correction::Objective objective :
       {correction::Objective::kShortest, correction::Objective::kSmoothest,
        correction::Objective::kSafest}) {
    request.options.objective = objective;
    const PlanResult limited = planned(*column_scene(), request);
    EXPECT_EQ(limited.status, Status::kOk) << limited.message;
    EXPECT_LE(count_inserted(limited), count_inserted(closest));
    if (limited.message.find("than the closest one") == std::string::npos) continue;
    ++closest_taken;
    EXPECT_THAT(limited.message, ::testing::HasSubstr("; none with at most " + limit));
    EXPECT_EQ(limited.measures->length_m, closest.measures->length_m);
  }
  EXPECT_GT(closest_taken, 0);
}

// The gap is narrower than the near quadrilateral at any orientation, and the walls are endless.
TEST(Plan, SaysHowHardItTried) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-80, -80, -0.05}, {-0.05, 80, 0.05});
  testing::add_cuboid(mesh, {0.05, -80, -0.05}, {80, 80, 0.05});
  PlanRequest request = bulging_tour();
  request.keyframes.erase(request.keyframes.begin() + 1);
  request.options.orientation.rule = correction::OrientationRule::kKeep;
  const PlanResult result = planned(*snapshot_of(std::move(mesh)), request);
  EXPECT_EQ(result.status, Status::kPartial);
  ASSERT_EQ(result.corrections.size(), 1U);
  EXPECT_GT(result.corrections[0].tried.directions, 0);
  EXPECT_GT(result.corrections[0].tried.lattice_points, 1000);
  EXPECT_THAT(result.message,
              ::testing::ContainsRegex("tried without success: .*places on a way round"));
}

TEST(Plan, ACameraAsTheBodyIsTheCamera) {
  PlanRequest request = bulging_tour();
  for (const Method method : {Method::kLadder, Method::kKeyframeInsertion}) {
    request.options.method = method;
    PlanRequest as_body = request;
    as_body.body = std::exchange(as_body.camera, {});
    EXPECT_EQ(numbers_of(planned(*column_scene(), as_body)),
              numbers_of(planned(*column_scene(), request)));
  }
}

// The slot is endless in y and narrower than the plate, which has to roll through it. The plate
// hangs below the eye, so a roll swings it.
TEST(Plan, ABodyOffTheEyeShiftsNoLessThanItsPointsMove) {
  constexpr int kInstants = 2'000;
  constexpr double kBetween = 1e-3;  // a share: what sampling misses
  Mesh mesh;
  testing::add_cuboid(mesh, {-80, -80, -0.05}, {-0.7, 80, 0.05});
  testing::add_cuboid(mesh, {-0.5, -80, -0.05}, {80, 80, 0.05});
  const auto snapshot = snapshot_of(std::move(mesh));
  PlanRequest request = bulging_tour();
  request.keyframes.erase(request.keyframes.begin() + 1);
  request.body = motion::BoxShape{Vec3(0, -0.8, 0), Vec3(0.4, 0.1, 0.1)};
  request.options.viewing_distance_m = 2.5;
  const PlanResult result = planned(*snapshot, request);
  ASSERT_EQ(result.status, Status::kOk) << result.message;
  ASSERT_EQ(result.corrections.size(), 1U);
  EXPECT_GT(result.corrections[0].turned_rad, 0.5);
  const motion::Body body = *motion::Body::make(*request.body);
  const motion::Path before = motion::interpolate(request.keyframes);
  double largest_m = 0.0;
  double mean_m = 0.0;
  for (int i = 0; i < kInstants; ++i) {
    const double time_s = 4.0 * (i + 0.5) / kInstants;
    const double moved_m =
        testing::farthest_move_m(body, before.pose(time_s), result.path.pose(time_s));
    largest_m = std::max(largest_m, moved_m);
    mean_m += moved_m / kInstants;
  }
  EXPECT_GE(result.measures->largest_shift_rad * 2.5, (1.0 - kBetween) * largest_m);
  EXPECT_LE(result.measures->largest_shift_rad * 2.5, 1.5 * largest_m);
  EXPECT_GE(result.measures->mean_shift_rad * 2.5, (1.0 - kBetween) * mean_m);
  EXPECT_EQ(result.corrections[0].shift.largest_rad, result.measures->largest_shift_rad);
  EXPECT_EQ(result.viewing_distance_m, 2.5);
}

TEST(Plan, TheViewingDistanceThatItTellsGivesTheSameAnswer) {
  Mesh mesh;
  testing::add_cuboid(mesh, {0.31, -3, -0.2}, {0.5, 3, 0.0});
  testing::add_cuboid(mesh, {-9, -9, -6}, {9, 9, -5});
  const auto snapshot = snapshot_of(std::move(mesh));
  PlanRequest request = bulging_tour();
  const PlanResult result = planned(*snapshot, request);
  ASSERT_TRUE(result.viewing_distance_m.has_value());
  EXPECT_GT(*result.viewing_distance_m, correction::kLeastViewingDistance_m);
  EXPECT_LT(*result.viewing_distance_m, correction::kMostViewingDistance_m);
  request.options.viewing_distance_m = result.viewing_distance_m;
  const PlanResult again = planned(*snapshot, request);
  EXPECT_EQ(again.viewing_distance_m, result.viewing_distance_m);
  EXPECT_EQ(numbers_of(again), numbers_of(result));
  EXPECT_EQ(again.measures, result.measures);
  request.options.viewing_distance_m = 0.7 * *result.viewing_distance_m;
  EXPECT_NE(planned(*snapshot, request).measures, result.measures);
  EXPECT_FALSE(planned(*snapshot_of({}), request).viewing_distance_m.has_value());
}

TEST(Plan, NamesOptionsThatItsMethodDoesNotLookAt) {
  PlanRequest request = bulging_tour();
  request.options.method = Method::kKeyframeInsertion;
  EXPECT_THAT(planned(*column_scene(), request).message,
              ::testing::Not(::testing::HasSubstr("does not look at")));
  request.options.orientation.rule = correction::OrientationRule::kKeep;
  request.options.objective = correction::Objective::kSafest;
  request.options.viewing_distance_m = 2.0;
  EXPECT_THAT(planned(*column_scene(), request).message,
              ::testing::HasSubstr("does not look at options.objective, options.orientation, "
                                   "options.viewing_distance_m"));
}

// The gap is 0.12 wide and endless in y; the quadrilateral is 0.2 wide and may not turn.
TEST(Plan, MakesTheCameraSmallerIfNothingElseHelpsAndItMay) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-80, -80, -0.05}, {-0.06, 80, 0.05});
  testing::add_cuboid(mesh, {0.06, -80, -0.05}, {80, 80, 0.05});
  const auto snapshot = snapshot_of(std::move(mesh));
  PlanRequest request = bulging_tour();
  request.keyframes.erase(request.keyframes.begin() + 1);
  request.options.deadline_s = 120.0;  // what it does is bounded; a busy machine is no reason
  request.options.orientation.rule = correction::OrientationRule::kKeep;
  EXPECT_EQ(planned(*snapshot, request).status, Status::kPartial);
  request.options.max_shrink = 0.6;
  const PlanResult smaller = planned(*snapshot, request);
  EXPECT_EQ(smaller.status, Status::kOk) << smaller.message;
  EXPECT_LT(smaller.near_scale, 1.0);
  EXPECT_GE(smaller.near_scale, 0.4);

  // The same camera as the body.
  PlanRequest as_body = request;
  as_body.body = std::exchange(as_body.camera, {});
  const PlanResult same = planned(*snapshot, as_body);
  EXPECT_EQ(numbers_of(same), numbers_of(smaller));
  EXPECT_EQ(same.near_scale, smaller.near_scale);
  EXPECT_EQ(same.message, smaller.message);
}

// A camera of a fifth of the size would miss the column.
TEST(Plan, MakesNothingSmallerWhereNothingIsToBeCorrected) {
  PlanRequest request = bulging_tour();
  request.options.max_inserted_keyframes = 0;
  const PlanResult asked = planned(*column_scene(), request);
  PlanRequest smaller = request;
  smaller.camera.near_m *= 0.2;
  ASSERT_EQ(planned(*column_scene(), smaller).status, Status::kOk);
  request.options.max_shrink = 0.8;
  const PlanResult result = planned(*column_scene(), request);
  EXPECT_EQ(result.status, Status::kPartial);
  EXPECT_EQ(result.near_scale, 1.0);
  EXPECT_EQ(result.message, asked.message);
  EXPECT_EQ(numbers_of(result), numbers_of(asked));
  EXPECT_THAT(result.message, ::testing::HasSubstr(
                                  "nothing was corrected, as options.max_inserted_keyframes asks"));
}

// Repairs and new times do not count as corrections, so requests for them are met.
TEST(Plan, RepairsAndSlowsThoughNothingIsToBeCorrected) {
  PlanRequest request = bulging_tour();
  request.keyframes[1].pose.position = {0.4, 0, 0.05};  // the quadrilateral is inside the column
  request.options.max_inserted_keyframes = 0;
  request.options.repair_keyframes = true;
  request.options.limits.speed_m_per_s = 0.5;
  request.options.limits.may_retime = true;
  const PlanResult result = planned(*column_scene(), request);
  EXPECT_EQ(result.keyframes.size(), 3U);
  EXPECT_TRUE(result.keyframes[1].is_repaired);
  EXPECT_GT(result.time_scale, 1.0);
}

TEST(Plan, CorrectionsTurnNothingWhereTheOrientationIsKept) {
  PlanRequest request = bulging_tour();
  request.options.orientation.rule = correction::OrientationRule::kKeep;
  const PlanResult result = planned(*column_scene(), request);
  EXPECT_EQ(result.status, Status::kOk) << result.message;
  for (int i = 0; i <= 100; ++i) {
    EXPECT_LT(result.path.pose(0.04 * i).orientation.angularDistance(Quat::Identity()), 1e-12);
  }
}

TEST(Plan, NotesThatNoKeyframeLiesInTheScene) {
  Mesh hall;
  testing::add_cuboid(hall, {-3, -3, -3}, {3, 3, 3});
  const auto snapshot = snapshot_of(std::move(hall));
  PlanRequest request = bulging_tour();
  EXPECT_THAT(planned(*snapshot, request).message, ::testing::Not(::testing::HasSubstr("scale")));
  for (motion::Keyframe& keyframe : request.keyframes) keyframe.pose.position *= 39.37;
  request.keyframes[1].pose.position.x() += 100.0;
  EXPECT_THAT(planned(*snapshot, request).message, ::testing::HasSubstr("scale"));
}

TEST(Plan, ACollidingKeyframeIsNamed) {
  PlanRequest request = bulging_tour();
  request.keyframes[1].pose.position = {0.35, 0, 0.0};
  const PlanResult result = planned(*column_scene(), request);
  EXPECT_EQ(result.status, Status::kInvalid);
  EXPECT_EQ(result.keyframe, 1u);
  EXPECT_THAT(result.message, ::testing::HasSubstr("keyframes[1]"));
  EXPECT_TRUE(result.path.empty());
}

TEST(Plan, AnInvalidRequestIsAResult) {
  PlanRequest request = bulging_tour();
  request.keyframes[2].pose.position.x() = std::numeric_limits<double>::quiet_NaN();
  const PlanResult result = planned(*column_scene(), request);
  EXPECT_EQ(result.status, Status::kInvalid);
  EXPECT_EQ(result.keyframe, 2u);
}

TEST(Plan, TheDeadlineGivesTimeoutNeverAWrongOk) {
  const PlanResult result = plan(*column_scene(), bulging_tour(), base::Deadline::after_s(0.0));
  EXPECT_EQ(result.status, Status::kTimeout);
  ASSERT_EQ(result.remaining_collisions.size(), 1u);
  EXPECT_EQ(result.remaining_collisions[0], (collision::CollisionInterval{0.0, 4.0}));
  EXPECT_THAT(result.message,
              ::testing::StartsWith("the deadline of 10 s was reached before the path was searched "
                                    "for collisions: nothing is known of it"));
}

TEST(Plan, SaysHowFarItIs) {
  const auto progress = std::make_shared<base::Progress>();
  const PlanResult result =
      plan(*column_scene(), bulging_tour(), base::Deadline::never().watched({}, progress));
  ASSERT_FALSE(result.corrections.empty());
  const auto corrected =
      std::ranges::count_if(result.corrections, [](const correction::Correction& correction) {
        return correction.kind != correction::CorrectionKind::kNone;
      });
  EXPECT_EQ(progress->stage, base::Progress::Stage::kCertifying);
  EXPECT_EQ(progress->collisions, static_cast<int>(result.corrections.size()));
  EXPECT_EQ(progress->corrected, static_cast<int>(corrected));
}

TEST(Plan, ToldToStopItChecksNothingAnyMore) {
  std::stop_source stop;
  stop.request_stop();
  const auto progress = std::make_shared<base::Progress>();
  const PlanResult result = plan(*column_scene(), bulging_tour(),
                                 base::Deadline::never().watched(stop.get_token(), progress));
  EXPECT_EQ(result.status, Status::kTimeout);
  EXPECT_FALSE(result.certificate.certified);
  ASSERT_EQ(result.remaining_collisions.size(), 1u);
}

TEST(Plan, DerivesTimesAndNormalisesQuaternions) {
  PlanRequest request = bulging_tour();
  request.has_times = false;
  for (motion::Keyframe& keyframe : request.keyframes) {
    keyframe.time_s = std::numeric_limits<double>::quiet_NaN();
    keyframe.pose.orientation.coeffs() *= 5.0;
  }
  const PlanResult result = planned(*snapshot_of(Mesh{}), request);
  ASSERT_EQ(result.status, Status::kOk) << result.message;
  EXPECT_EQ(result.keyframes[0].time_s, 0.0);
  for (const motion::Keyframe& keyframe : result.keyframes) {
    EXPECT_NEAR(keyframe.pose.orientation.norm(), 1.0, 1e-15);
    EXPECT_NEAR((result.path.pose(keyframe.time_s).position - keyframe.pose.position).norm(), 0.0,
                1e-12);
  }
}

TEST(Plan, IsBitIdenticalFromAnyThread) {
  const std::shared_ptr<const Snapshot> snapshot = column_scene();
  const std::vector<double> alone = numbers_of(planned(*snapshot, bulging_tour()));
  std::vector<std::vector<double>> others(4);
  {
    std::vector<std::jthread> threads;
    for (std::vector<double>& other : others) {
      threads.emplace_back([&] { other = numbers_of(planned(*snapshot, bulging_tour())); });
    }
  }
  for (const std::vector<double>& other : others) {
    ASSERT_EQ(other.size(), alone.size());
    EXPECT_EQ(std::memcmp(other.data(), alone.data(), alone.size() * sizeof(double)), 0);
  }
}

TEST(Status, NamesRoundTrip) {
  for (const Status status : {Status::kOk, Status::kPartial, Status::kInfeasible, Status::kTimeout,
                              Status::kInvalid, Status::kUnknownScene, Status::kInternalError}) {
    EXPECT_EQ(base::value_of<Status>(to_string(status)), status);
  }
  EXPECT_FALSE(base::value_of<Status>("fine"));
}

}  // namespace
}  // namespace camway::planning
