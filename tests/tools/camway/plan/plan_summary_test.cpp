// SPDX-License-Identifier: MIT
#include "tools/camway/plan/plan_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/camway/replay/log_builder.h"
#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

using correction::Correction;
using correction::CorrectionKind;
using planning::PlanResult;
using planning::Status;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Correction corrected(double begin_s, double end_s, CorrectionKind kind, double moved_m,
                     double turned_rad) {
  Correction correction;
  correction.interval = {begin_s, end_s};
  correction.kind = kind;
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

// Corrections that touch are drawn as one change, of which the dearest kind is told.
TEST(PlanSummary, TellsOnceWhatCorrectedCollisionsInSeveralWays) {
  const PlanResult result = result_with({corrected(1, 2, CorrectionKind::kGoRound, 2.0, 0.0),
                                         corrected(3, 3.01, CorrectionKind::kMove, 2.0, 0.0),
                                         corrected(4, 5, CorrectionKind::kMove, 0.1, 0.0),
                                         corrected(6, 7, CorrectionKind::kNone, 2.0, 0.0)});
  EXPECT_THAT(plan_summary(result, nullptr),
              EndsWith("\n  1.00-2.00, 3.00-3.01 s: collides; goes another way, moved up to 2 m\n"
                       "  4.00-5.00 s: collides; moved up to 0.1 m\n"
                       "  6.00-7.00 s: collides; not corrected"));
}

TEST(PlanSummary, SaysWhatEachCorrectionDid) {
  PlanResult result = result_with({corrected(2.314, 2.649, CorrectionKind::kMove, 0.1234, 0.0),
                                   corrected(3, 4, CorrectionKind::kTurn, 0.0, 0.0698),
                                   corrected(5, 6, CorrectionKind::kGoRound, 1.26, 0.5),
                                   corrected(7, 8, CorrectionKind::kShrink, 0.0, 0.0),
                                   corrected(9, 10, CorrectionKind::kNone, 0.0, 0.0)});
  result.collisions[0].witness.emplace();
  result.collision_names[0] = {"sofa_04", "edge 2"};
  result.collisions[4].witness.emplace();
  result.collision_names[4] = {"", "corner 1"};
  EXPECT_THAT(
      plan_summary(result, nullptr),
      EndsWith(
          "\n  2.31-2.65 s: collides with sofa_04; moved up to 0.12 m\n"
          "  3.00-4.00 s: collides; turned up to 4 degrees\n"
          "  5.00-6.00 s: collides; goes another way, moved up to 1.3 m, turned up to 29 degrees\n"
          "  7.00-8.00 s: collides; near distance made smaller\n"
          "  9.00-10.00 s: collides with the scene; not corrected"));
}

TEST(PlanSummary, LeavesRoundingOutAndLargeNumbersWhole) {
  const PlanResult result =
      result_with({corrected(1, 2, CorrectionKind::kMove, 0.046, 2e-16),
                   corrected(3, 4, CorrectionKind::kGoRound, 123.4, 2.1),
                   corrected(5.001, 5.002, CorrectionKind::kTurn, 1e-15, 1e-9)});
  EXPECT_THAT(
      plan_summary(result, nullptr),
      EndsWith(
          "  1.00-2.00 s: collides; moved up to 0.046 m\n"
          "  3.00-4.00 s: collides; goes another way, moved up to 123 m, turned up to 120 degrees\n"
          "  5.00 s: collides; turned"));
}

TEST(PlanSummary, SaysAtWhichViewingDistanceThePictureShifts) {
  PlanResult result = result_with({corrected(1, 2, CorrectionKind::kMove, 0.1, 0.0)});
  result.measures.emplace().largest_shift_rad = radians(0.62);
  EXPECT_THAT(plan_summary(result, nullptr), EndsWith("moved up to 0.1 m")) << "as of a daemon";
  result.viewing_distance_m = 4.2187;
  EXPECT_THAT(plan_summary(result, nullptr),
              EndsWith("moved up to 0.1 m\n"
                       "  shifted up to 0.62 degrees at a viewing distance of 4.2 m"));
}

TEST(PlanSummary, BeginsWithStatusMessageAndTimes) {
  PlanResult result = result_with({corrected(1, 2, CorrectionKind::kMove, 0.1, 0.1)});
  result.timing.load_scene_ms = 1234.0;
  result.timing.total_ms = 1.25;
  EXPECT_THAT(plan_summary(result, nullptr),
              StartsWith("ok: all is well (scene read in 1.23 s, planned in 1.2 ms)\n"));
}

// A detour replaces the whole path between two keyframes, for all collisions in it.
TEST(PlanSummary, HasALineForEachChangeOfThePath) {
  PlanResult result = result_with({corrected(1, 2, CorrectionKind::kGoRound, 0.5, 0.0),
                                   corrected(2.5, 2.75, CorrectionKind::kMove, 0.1, 0.0),
                                   corrected(3, 4, CorrectionKind::kGoRound, 0.5, 0.0),
                                   corrected(5, 5, CorrectionKind::kGoRound, 0.5, 0.0)});
  for (const std::size_t i : {0U, 2U, 3U}) result.collisions[i].witness.emplace();
  result.collision_names[0] = {"sofa", "edge 2"};
  result.collision_names[2] = {"lamp", "inside"};
  result.collision_names[3] = {"sofa", "edge 2"};
  EXPECT_THAT(plan_summary(result, nullptr),
              EndsWith("\n  1.00-2.00, 3.00-4.00, 5.00 s: collides with sofa, lamp; goes another "
                       "way, moved up to 0.5 m\n"
                       "  2.50-2.75 s: collides; moved up to 0.1 m"));
}

TEST(PlanSummary, SaysHowHardItTried) {
  PlanResult result = result_with(
      {corrected(1, 2, CorrectionKind::kNone, 0, 0), corrected(3, 4, CorrectionKind::kNone, 0, 0)});
  result.corrections[0].tried = {14, 1, 20000, 0};
  EXPECT_THAT(
      plan_summary(result, nullptr),
      EndsWith("  1.00-2.00 s: collides; not corrected, tried 14 directions to move or turn in, "
               "1 changed path, 20000 places on a way round\n"
               "  3.00-4.00 s: collides; not corrected"));
}

TEST(PlanSummary, ManyCollisionsOfOneChangeAreCounted) {
  const std::vector<Correction> six(6, corrected(1, 2, CorrectionKind::kGoRound, 4.2, 0.0));
  PlanResult result = result_with(six);
  for (std::size_t i = 0; i < six.size(); ++i) {
    result.corrections[i].interval = {static_cast<double>(i), static_cast<double>(i) + 0.5};
    result.collisions[i].witness.emplace();
    result.collision_names[i] = {"wall_" + std::to_string(i), "edge 0"};
  }
  EXPECT_THAT(plan_summary(result, nullptr),
              EndsWith("\n  0.00-5.50 s, 6 times: collides with wall_0, wall_1, wall_2, ...; goes "
                       "another way, moved up to 4.2 m"));
}

TEST(PlanSummary, CutsLongLists) {
  std::vector<Correction> corrections;
  for (int i = 0; i < 23; ++i)
    corrections.push_back(corrected(i, i + 1, CorrectionKind::kMove, 0.1 * i, 0));
  const PlanResult result = result_with(std::move(corrections));
  const std::string text = plan_summary(result, nullptr);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 21);
  EXPECT_THAT(text, EndsWith("\n  and 3 more"));
}

TEST(PlanSummary, NamesTheObjectsOfAProof) {
  PlanResult result;
  result.status = Status::kInfeasible;
  result.message = "no path exists";
  result.infeasibility = planning::Infeasibility{2, 0, {1, 2, 3}};
  const scene::Mesh mesh = wall_mesh();  // "wall" is triangles 0 and 1, "fin" 2 and 3
  EXPECT_THAT(plan_summary(result, &mesh), EndsWith("\n  the surface belongs to wall, fin"));
  result.infeasibility->triangles = {3};
  EXPECT_THAT(plan_summary(result, &mesh), EndsWith("\n  the surface belongs to fin"));
  EXPECT_THAT(plan_summary(result, nullptr), Not(HasSubstr("\n"))) << "the message says the rest";
  result.infeasibility->cage.emplace();
  EXPECT_THAT(plan_summary(result, &mesh), EndsWith("\n  the box is made of fin"));
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
  fault.keyframe = 5;
  fault.depth_m = 0.0;
  result.keyframe_faults.push_back(fault);
  EXPECT_EQ(plan_summary(result, nullptr),
            "R.json: keyframes[1]: collides\n"
            "  keyframe 1: collides by 0.13 m; no free pose was found near it\n"
            "  keyframe 3: collides by 0.13 m; free at [1.235, 2, -3]\n"
            "  keyframe 5: collides; free at [1.235, 2, -3]");
  result.status = Status::kOk;
  EXPECT_THAT(plan_summary(result, nullptr), HasSubstr("by 0.13 m; moved to [1.235, 2, -3]"));
  result.status = Status::kInvalid;
  result.keyframe_faults.resize(1);
  EXPECT_EQ(plan_summary(result, nullptr), "R.json: keyframes[1]: collides") << "said already";
}

TEST(PlanSummary, SaysWhereThePathWasSlowed) {
  PlanResult result;
  EXPECT_THAT(plan_summary(result, nullptr), Not(HasSubstr("\n")));
  result.time_scale = 1.25;
  result.slowed = {{1.0, 2.5, 1.0, 1.5}, {4.0, 4.25, 3.0, 3.125}};
  EXPECT_THAT(plan_summary(result, nullptr), EndsWith("\n  slowed at 1.00-2.50 s, 4.00-4.25 s"));
}

}  // namespace
}  // namespace camway::tools
