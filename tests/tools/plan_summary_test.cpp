// SPDX-License-Identifier: MIT
#include "tools/camway/plan_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/log_builder.h"

namespace camway::tools {
namespace {

using correction::Correction;
using correction::Rung;
using planning::PlanResult;
using planning::Status;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Correction corrected(double begin_s, double end_s, Rung rung, double moved_m, double turned_rad) {
  Correction correction;
  correction.interval = {begin_s, end_s};
  correction.rung = rung;
  correction.moved_m = moved_m;
  correction.turned_rad = turned_rad;
  return correction;
}

PlanResult result_with(std::vector<Correction> corrections) {
  PlanResult result;
  result.status = Status::kOk;
  result.message = "all is well";
  for (const Correction& correction : corrections) {
    result.collisions.push_back(correction.interval);
    result.collision_names.emplace_back();
  }
  result.corrections = std::move(corrections);
  return result;
}

TEST(PlanSummary, SaysWhatEachCorrectionDid) {
  PlanResult result = result_with(
      {corrected(2.314, 2.649, Rung::kMove, 0.1234, 0.0), corrected(3, 4, Rung::kTurn, 0.0, 0.0698),
       corrected(5, 6, Rung::kGoRound, 1.26, 0.5), corrected(7, 8, Rung::kShrink, 0.0, 0.0),
       corrected(9, 10, Rung::kNone, 0.0, 0.0)});
  result.collisions[0].witness.emplace();
  result.collision_names[0] = {"sofa_04", "edge 2"};
  result.collisions[4].witness.emplace();
  result.collision_names[4] = {"", "corner 1"};
  EXPECT_THAT(plan_summary(result, nullptr),
              EndsWith("all is well\n"
                       "  2.31-2.65 s: moved 0.12 m (edge 2 met sofa_04)\n"
                       "  3.00-4.00 s: turned 4 degrees\n"
                       "  5.00-6.00 s: goes round, moved 1.3 m, turned 29 degrees\n"
                       "  7.00-8.00 s: near distance made smaller\n"
                       "  9.00-10.00 s: not corrected (corner 1 met the scene)"));
}

TEST(PlanSummary, LeavesRoundingOutAndLargeNumbersWhole) {
  const PlanResult result = result_with({corrected(1, 2, Rung::kMove, 0.046, 2e-16),
                                         corrected(3, 4, Rung::kGoRound, 123.4, 2.1),
                                         corrected(5.001, 5.002, Rung::kTurn, 1e-15, 1e-9)});
  EXPECT_THAT(plan_summary(result, nullptr),
              EndsWith("  1.00-2.00 s: moved 0.046 m\n"
                       "  3.00-4.00 s: goes round, moved 123 m, turned 120 degrees\n"
                       "  5.00 s: turned"));
}

TEST(PlanSummary, BeginsWithAllInOneLine) {
  PlanResult result = result_with({corrected(1, 2, Rung::kMove, 0.1, 0.1)});
  result.keyframes.resize(3);
  result.keyframes[1].origin = motion::KeyframeOrigin::kInserted;
  result.timing.total_ms = 1.25;
  EXPECT_THAT(plan_summary(result, nullptr),
              StartsWith("ok: 1 collision before correction, 1 keyframe inserted, 0 collisions "
                         "remaining, planned in 1.2 ms, scene loaded in 0.0 ms: all is well\n"));
}

// A way round replaces all between two keyframes, whatever that collided with.
TEST(PlanSummary, HasALineForEachChangeOfThePath) {
  PlanResult result = result_with(
      {corrected(1, 2, Rung::kGoRound, 0.5, 0.0), corrected(2.5, 2.75, Rung::kMove, 0.1, 0.0),
       corrected(3, 4, Rung::kGoRound, 0.5, 0.0), corrected(5, 5, Rung::kGoRound, 0.5, 0.0)});
  for (const std::size_t i : {0U, 2U, 3U}) result.collisions[i].witness.emplace();
  result.collision_names[0] = {"sofa", "edge 2"};
  result.collision_names[2] = {"lamp", "inside"};
  result.collision_names[3] = {"sofa", "edge 2"};
  EXPECT_THAT(
      plan_summary(result, nullptr),
      EndsWith("all is well\n"
               "  1.00-2.00, 3.00-4.00, 5.00 s: goes round, moved 0.5 m (edge 2 met sofa, the "
               "inside met lamp)\n"
               "  2.50-2.75 s: moved 0.1 m"));
}

TEST(PlanSummary, SaysHowHardItTried) {
  PlanResult result =
      result_with({corrected(1, 2, Rung::kNone, 0, 0), corrected(3, 4, Rung::kNone, 0, 0)});
  result.corrections[0].tried = {14, 1, 20000, 0};
  EXPECT_THAT(plan_summary(result, nullptr),
              EndsWith("  1.00-2.00 s: not corrected; tried 14 directions, 1 changed path, 20000 "
                       "lattice points\n"
                       "  3.00-4.00 s: not corrected"));
}

TEST(PlanSummary, CutsLongLists) {
  std::vector<Correction> corrections;
  for (int i = 0; i < 23; ++i) corrections.push_back(corrected(i, i + 1, Rung::kMove, 0.1 * i, 0));
  const PlanResult result = result_with(std::move(corrections));
  const std::string text = plan_summary(result, nullptr);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 21);
  EXPECT_THAT(text, EndsWith("\n  and 3 more"));
}

TEST(PlanSummary, NamesTheObjectsOfAProof) {
  PlanResult result;
  result.status = Status::kInfeasible;
  result.message = "there is no path";
  result.infeasibility = planning::Infeasibility{2, 0, {1, 2, 3}};
  const scene::Mesh mesh = wall_mesh();  // "wall" is triangles 0 and 1, "fin" 2 and 3
  EXPECT_THAT(plan_summary(result, &mesh),
              EndsWith("keyframe 2 is inside and keyframe 0 outside of a closed surface of 3 "
                       "triangles: wall, fin"));
  result.infeasibility->triangles = {3};
  EXPECT_THAT(plan_summary(result, &mesh), EndsWith("a closed surface of 1 triangle: fin"));
  EXPECT_THAT(plan_summary(result, nullptr), EndsWith("a closed surface of 1 triangle"));
  correction::CageBox& cage = result.infeasibility->cage.emplace();
  cage.box = geometry::Box(geometry::Vec3(0, 0, 0), geometry::Vec3(1, 2, 3.5));
  cage.widest_hole_m = 0.0849;
  cage.shortest_chord_m = 0.123;
  EXPECT_THAT(
      plan_summary(result, &mesh),
      EndsWith("keyframe 2 is inside and keyframe 0 outside of a cage of 1 x 2 x 3.5 m made "
               "of 1 triangle, its holes at most 0.0849 m wide and the camera 0.123 m: fin"));
}

TEST(PlanSummary, SaysWhatIsWrongWithKeyframes) {
  PlanResult result;
  result.status = Status::kInvalid;
  result.message = "R.json: keyframes[1]: collides";
  planning::KeyframeFault fault;
  fault.keyframe = 1;
  fault.depth_m = 0.126;
  result.keyframe_faults = {fault};
  fault.keyframe = 3;
  fault.free_pose = motion::Pose{{1.23456, 2, -3}, geometry::Quat(1, 0, 0, 0)};
  result.keyframe_faults.push_back(fault);
  EXPECT_EQ(plan_summary(result, nullptr),
            "R.json: keyframes[1]: collides\n"
            "  keyframe 1: 0.13 m too deep, no free pose was found near it\n"
            "  keyframe 3: 0.13 m too deep, free at [1.235, 2, -3]");
  result.status = Status::kOk;
  EXPECT_THAT(plan_summary(result, nullptr), HasSubstr("too deep, moved to [1.235, 2, -3]"));
}

TEST(PlanSummary, SaysWhatWasScaled) {
  PlanResult result;
  EXPECT_THAT(plan_summary(result, nullptr), Not(HasSubstr("\n")));
  result.near_scale = 0.8;
  result.time_scale = 1.25;
  result.slowed = {{1.0, 2.5, 1.0, 1.5}, {4.0, 4.25, 3.0, 3.125}};
  EXPECT_THAT(
      plan_summary(result, nullptr),
      EndsWith("\n  the near distance is 0.8 of the one asked for"
               "\n  to meet the limits it takes 1.25 times as long, slowed at 1-2.5 s, 4-4.25 s"));
}

}  // namespace
}  // namespace camway::tools
