// SPDX-License-Identifier: MIT
#include "daemon/messages/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "lcmtypes/wire/check.h"
#include "tests/messages/plan_samples.h"
#include "tests/messages/request_on_wire.h"
#include "tests/support/random.h"

namespace camway::messages {
namespace {

using testing::kSeed;
using testing::Random;
using testing::sample_result;

const RequestIds kIds{"tester", -3, 1'000'000};

TEST(WireAnswer, NamesOfWitnessesAreCutToTheirLimits) {
  planning::PlanResult result;
  result.collisions = {{0.0, 1.0, collision::Witness{}}};
  EXPECT_EQ(to_wire(result, {kIds, "", 0, ""}).collisions[0].witness_object, "") << "not named";
  result.collision_names = {{std::string(5000, 'o'), std::string(5000, 'f')}};
  const plan_response_t wire = to_wire(result, {kIds, "", 0, ""});
  EXPECT_EQ(wire.collisions[0].witness_object.size(), wire::kMaxObjectNameBytes);
  EXPECT_FALSE(wire::check(wire::layout_of<plan_response_t>(), wire::encode(wire)));
}

// A client reads the numbers; `AReportHasItsNumbersWhereTheTypesSayTheyAre` and `Difference` look
// at each member.
TEST(WireAnswer, APathIsReadBackBitForBit) {
  Random random(kSeed);
  for (const std::size_t segments : {0U, 1U, 40U}) {
    const planning::PlanResult result = sample_result(segments, random);
    const plan_response_t wire = to_wire(result, {kIds, "room", 7, "abc"});
    const auto path = path_of(wire.segments);
    ASSERT_TRUE(path) << path.error;
    planning::PlanResult back = result;
    back.path = *path;
    EXPECT_EQ(path->segments().size(), segments);
    EXPECT_EQ(wire::encode(to_wire(back, {kIds, "room", 7, "abc"})), wire::encode(wire));
  }
}

TEST(WireAnswer, WithoutTimesLeavesOutTimesAlone) {
  Random random(kSeed);
  const plan_response_t answer =
      to_wire(sample_result(5, random), {{"tester", 7, 1'000'000}, "room", 7, "abc"});
  plan_response_t other = answer;
  other.utime = 5;
  other.daemon_start = {3, 1};
  for (double* member : {&other.motion_ms, &other.detect_ms, &other.correct_ms, &other.certify_ms,
                         &other.total_ms}) {
    *member += 1.0;
  }
  ASSERT_NE(wire::encode(other), wire::encode(answer));
  EXPECT_EQ(wire::encode(without_times(other)), wire::encode(without_times(answer)));
  other.time_scale = std::nextafter(other.time_scale, 2.0);
  EXPECT_NE(wire::encode(without_times(other)), wire::encode(without_times(answer)));
}

TEST(WireAnswer, TheWatchedPartIsRefusedWhereItIsNoResult) {
  Random random(kSeed);
  plan_response_t answer = to_wire(sample_result(5, random), {kIds, "room", 7, "abc"});
  answer.keyframe_faults.assign(1, keyframe_fault_t{});
  answer.keyframe_faults[0].keyframe = 3;
  answer.keyframe_faults[0].has_free_pose = 1;
  answer.keyframe_faults[0].free_orientation_wxyz[0] = 2.0;
  ASSERT_TRUE(watched_part_of(answer, 4)) << watched_part_of(answer, 4).error;
  EXPECT_FALSE(watched_part_of(answer, 3)) << "no such keyframe";
  answer.keyframe_faults[0].keyframe = -1;
  EXPECT_FALSE(watched_part_of(answer, 4));
  answer.keyframe_faults[0].keyframe = 0;
  answer.keyframe_faults[0].free_orientation_wxyz[0] = 0.0;
  EXPECT_FALSE(watched_part_of(answer, 4)) << "no orientation";
  answer.keyframe_faults.clear();
  answer.segments[1].t0_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(watched_part_of(answer, 4)) << "no path";
}

TEST(WireAnswer, APathHasItsNumbersWhereTheTypesSayTheyAre) {
  motion::Segment segment;
  segment.t0_s = 1.0;
  segment.t1_s = 2.0;
  for (std::size_t i = 0; i < 4; ++i) segment.position[i].setConstant(static_cast<double>(i));
  for (std::size_t i = 0; i < 7; ++i) segment.orientation[i].setConstant(static_cast<double>(i));
  segment.position[3].z() = 0.5;
  segment.orientation[6].w() = 0.25;  // the last of four
  planning::PlanResult result;
  result.path = motion::Path({segment});
  result.keyframes.resize(2);
  result.keyframes[1] = {2.5, {{1, 2, 3}, geometry::Quat(0.1, 0.2, 0.3, 0.4)}};
  result.keyframes[1].origin = motion::KeyframeOrigin::kInserted;
  result.keyframes[1].is_repaired = true;
  result.keyframes[1].image = {5, 6, 7, 8};
  result.frame = {{1, 2, 3, 4}, {{5, 6, 7}, {8, 9, 10, 11}}, {{12, 13, 14}, {15, 16, 17, 18}}};
  const plan_response_t wire = to_wire(result, {kIds, "", 0, ""});
  ASSERT_EQ(wire.num_segments, 1);
  EXPECT_EQ(wire.segments[0].t0_s, 1.0);
  EXPECT_EQ(wire.segments[0].t1_s, 2.0);
  EXPECT_EQ(wire.segments[0].position_m[2][1], 2.0);
  EXPECT_EQ(wire.segments[0].position_m[3][2], 0.5);
  EXPECT_EQ(wire.segments[0].orientation_wxyz[5][0], 5.0);
  EXPECT_EQ(wire.segments[0].orientation_wxyz[6][3], 0.25);
  ASSERT_EQ(wire.num_keyframes, 2);
  EXPECT_EQ(wire.keyframes[0].origin, keyframe_t::ORIGIN_GIVEN);
  EXPECT_EQ(wire.keyframes[0].repaired, 0);
  EXPECT_EQ(wire.keyframes[1].time_s, 2.5);
  EXPECT_EQ(wire.keyframes[1].position_m[2], 3.0);
  EXPECT_EQ(wire.keyframes[1].orientation_wxyz[0], 0.1);
  EXPECT_EQ(wire.keyframes[1].orientation_wxyz[3], 0.4);
  EXPECT_EQ(wire.keyframes[1].origin, keyframe_t::ORIGIN_INSERTED);
  EXPECT_EQ(wire.keyframes[1].repaired, 1);
  EXPECT_EQ(wire.keyframes[1].image[3], 8.0);
  EXPECT_EQ(wire.has_frame, 1);
  EXPECT_EQ(wire.frame.reference_wxyz[3], 4.0);
  EXPECT_EQ(wire.frame.end.image_rate_per_s[0], 15.0);
}

TEST(WireAnswer, CollisionsHaveTheirNumbersWhereTheTypesSayTheyAre) {
  planning::PlanResult result;
  result.collisions = {{1.0, 2.0, collision::Witness{1.5, 7, 2, 0.25, {1, 2, 3}}}, {3.0, 4.0}};
  result.collision_names = {{"table", "edge 1"}, {"", ""}};
  result.remaining_collisions = {{5.0, 6.0}};
  result.certificate = {true, 0.125};
  result.bounds.max_W.y() = 9.0;
  result.deadline_reached = true;
  result.timing = {1, 2, 3, 4, 5, 6};
  const plan_response_t wire = to_wire(result, {kIds, "", 0, ""});
  ASSERT_EQ(wire.num_collisions, 2);
  const collision_interval_t& first = wire.collisions[0];
  EXPECT_EQ(first.t_begin_s, 1.0);
  EXPECT_EQ(first.t_end_s, 2.0);
  EXPECT_EQ(first.has_witness, 1);
  EXPECT_EQ(first.witness_time_s, 1.5);
  EXPECT_EQ(first.witness_object, "table");
  EXPECT_EQ(first.witness_triangle, 7);
  EXPECT_EQ(first.witness_feature, "edge 1");
  EXPECT_EQ(first.witness_depth_m, 0.25);
  EXPECT_EQ(first.witness_point_m[2], 3.0);
  EXPECT_EQ(wire.collisions[1].has_witness, 0);
  ASSERT_EQ(wire.num_remaining, 1);
  EXPECT_EQ(wire.remaining[0].t_begin_s, 5.0);
  EXPECT_EQ(wire.certified, 1);
  EXPECT_EQ(wire.clearance_lower_bound_m, 0.125);
  EXPECT_EQ(wire.bounds.has_max[1], 1);
  EXPECT_EQ(wire.bounds.max_m[1], 9.0);
  EXPECT_EQ(wire.bounds.has_min[1], 0);
  EXPECT_EQ(wire.deadline_reached, 1);
  EXPECT_EQ(wire.motion_ms, 2.0);
  EXPECT_EQ(wire.total_ms, 6.0);
}

TEST(WireAnswer, AProofHasItsNumbersWhereTheTypesSayTheyAre) {
  planning::PlanResult result;
  const correction::CageBox cage{.box = {geometry::Vec3(0, 1, 2), geometry::Vec3(3, 4, 5)},
                                 .orientation = geometry::Quat(0.6, 0, 0, 0.8),
                                 .widest_hole_m = 0.0625,
                                 .shortest_chord_m = 0.25};
  result.infeasibility = planning::Infeasibility{3, 1, {2, 7}, cage};
  const plan_response_t wire = to_wire(result, {kIds, "", 0, ""});
  EXPECT_EQ(wire.has_infeasibility, 1);
  EXPECT_EQ(wire.keyframe_inside, 3);
  EXPECT_EQ(wire.keyframe_outside, 1);
  EXPECT_EQ(wire.proof_triangles, (std::vector<std::int32_t>{2, 7}));
  EXPECT_EQ(wire.has_cage, 1);
  EXPECT_EQ(wire.proof_cage.orientation_wxyz[3], 0.8);
  EXPECT_EQ(wire.proof_cage.min_m[2], 2.0);
  EXPECT_EQ(wire.proof_cage.max_m[0], 3.0);
  EXPECT_EQ(wire.proof_cage.widest_hole_m, 0.0625);
  EXPECT_EQ(wire.proof_cage.shortest_chord_m, 0.25);
}

TEST(WireAnswer, AReportHasItsNumbersWhereTheTypesSayTheyAre) {
  planning::PlanResult result;
  correction::Correction correction;
  correction.interval = {1.0, 2.0, collision::Witness{}};
  correction.kind = correction::CorrectionKind::kGoRound;
  correction.t_begin_s = 0.5;
  correction.t_end_s = 2.5;
  correction.moved_m = 0.25;
  correction.turned_rad = 0.125;
  correction.tried = {1, 2, 3, 4};
  result.corrections = {correction};
  motion::PathMeasures measures;
  measures.length_m = 7.0;
  measures.largest_turn_acceleration_rad_per_s2 = 8.0;
  measures.clearance_lower_bound_m = 9.0;
  result.measures = measures;
  result.viewing_distance_m = 4.5;
  planning::KeyframeFault fault;
  fault.keyframe = 4;
  fault.depth_m = 0.0625;
  fault.free_pose = motion::Pose{{1, 2, 3}, geometry::Quat(0.1, 0.2, 0.3, 0.4)};
  result.keyframe_faults = {fault};
  result.slowed = {{1.5, 2.5, 1.0, 1.25}};
  const plan_response_t wire = to_wire(result, {kIds, "", 0, ""});
  ASSERT_EQ(wire.num_corrections, 1);
  EXPECT_EQ(wire.corrections[0].t_end_s, 2.0);
  EXPECT_EQ(wire.corrections[0].method, correction_t::GO_ROUND);
  EXPECT_EQ(wire.corrections[0].changed_t_begin_s, 0.5);
  EXPECT_EQ(wire.corrections[0].changed_t_end_s, 2.5);
  EXPECT_EQ(wire.corrections[0].moved_m, 0.25);
  EXPECT_EQ(wire.corrections[0].turned_rad, 0.125);
  EXPECT_EQ(wire.corrections[0].tried_directions, 1);
  EXPECT_EQ(wire.corrections[0].tried_paths, 2);
  EXPECT_EQ(wire.corrections[0].tried_lattice_points, 3);
  EXPECT_EQ(wire.corrections[0].tried_tree_samples, 4);
  EXPECT_EQ(wire.has_measures_before, 0);
  EXPECT_EQ(wire.has_measures, 1);
  EXPECT_EQ(wire.measures.length_m, 7.0);
  EXPECT_EQ(wire.measures.largest_turn_acceleration_rad_per_s2, 8.0);
  EXPECT_EQ(wire.measures.clearance_lower_bound_m, 9.0);
  EXPECT_EQ(wire.viewing_distance_m, 4.5);
  ASSERT_EQ(wire.num_slowed, 1);
  EXPECT_EQ(wire.slowed[0].t_begin_s, 1.5);
  EXPECT_EQ(wire.slowed[0].t_end_s, 2.5);
  EXPECT_EQ(wire.slowed[0].given_t_begin_s, 1.0);
  EXPECT_EQ(wire.slowed[0].given_t_end_s, 1.25);
  ASSERT_EQ(wire.num_keyframe_faults, 1);
  EXPECT_EQ(wire.keyframe_faults[0].keyframe, 4);
  EXPECT_EQ(wire.keyframe_faults[0].free_position_m[2], 3.0);
  EXPECT_EQ(wire.keyframe_faults[0].free_orientation_wxyz[0], 0.1);
  EXPECT_EQ(wire.has_infeasibility, 0);
  EXPECT_EQ(wire.keyframe_inside, -1);
  EXPECT_EQ(wire.near_scale, 1.0);
}

TEST(WireAnswer, QuaternionsAreOrderedWxyzOnTheWire) {
  planning::PlanRequest request;
  request.keyframes.resize(1);
  request.keyframes[0].pose.orientation = geometry::Quat(0.1, 0.2, 0.3, 0.4);  // w, x, y, z
  const plan_request_t wire = to_wire(request, kIds);
  EXPECT_EQ(wire.keyframes[0].orientation_wxyz[0], 0.1);
  EXPECT_EQ(wire.keyframes[0].orientation_wxyz[3], 0.4);
  EXPECT_EQ(from_wire(wire)->keyframes[0].pose.orientation.w(), 0.1);
}

TEST(WireAnswer, EveryPlanningStatusHasItsNumber) {
  using planning::Status;
  const std::vector<std::pair<Status, std::int32_t>> table{
      {Status::kOk, 0},           {Status::kPartial, 1}, {Status::kInfeasible, 2},
      {Status::kTimeout, 3},      {Status::kInvalid, 4}, {Status::kUnknownScene, 5},
      {Status::kInternalError, 6}};
  for (const auto& [status, number] : table) {
    planning::PlanResult result;
    result.status = status;
    const plan_response_t wire = to_wire(result, {kIds, "", 0, ""});
    EXPECT_EQ(wire.status, number);
  }
}

TEST(WireAnswer, TheViewingDistanceIsZeroForNone) {
  planning::PlanResult result;
  result.measures = motion::PathMeasures{};
  EXPECT_EQ(to_wire(result, {kIds, "", 0, ""}).viewing_distance_m, 0.0);
  EXPECT_EQ(plain_answer(plan_response_t::STATUS_OVERLOADED, "", {}).viewing_distance_m, 0.0);
}

TEST(WireAnswer, KeyframeAtFaultIsMinusOneForNone) {
  planning::PlanResult result;
  EXPECT_EQ(to_wire(result, {kIds, "", 0, ""}).keyframe, -1);
  result.keyframe = 3;
  EXPECT_EQ(to_wire(result, {kIds, "", 0, ""}).keyframe, 3);
}

TEST(WireAnswer, SegmentsThatAreNoPathAreRefused) {
  Random random(kSeed);
  const plan_response_t good = to_wire(sample_result(4, random), {kIds, "room", 7, "abc"});
  plan_response_t gap = good;
  gap.segments[2].t0_s += 0.01;
  EXPECT_EQ(path_of(gap.segments).error, "segments[2]: does not begin where the one before ends");
  plan_response_t backward = good;
  backward.segments[0].t1_s = backward.segments[0].t0_s;
  EXPECT_EQ(path_of(backward.segments).error, "segments[0]: does not end after it begins");
  plan_response_t nan = good;
  nan.segments[3].t1_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(path_of(nan.segments).error, "segments[3]: holds numbers that are not finite");
}

TEST(WireAnswer, LongTextsAreCutToTheirLimits) {
  planning::PlanResult result;
  result.message = std::string(5000, 'm');
  const plan_response_t wire = to_wire(result, {kIds, std::string(5000, 's'), 0, ""});
  EXPECT_FALSE(wire::check(wire::layout_of<plan_response_t>(), wire::encode(wire)));
}

}  // namespace
}  // namespace camway::messages
