// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/best_known.h"

#include <gtest/gtest.h>

#include "daemon/motion/spline/bump.h"
#include "daemon/motion/spline/path_frame.h"
#include "daemon/planning/plan.h"
#include "tests/bench/fidelity/answers.h"
#include "tests/bench/fidelity/changed_ranges.h"
#include "tests/bench/fidelity/other_sides.h"
#include "tests/bench/fidelity/test_shots.h"

namespace camway::bench {
namespace {

using motion::CubicPath;
using testing::Random;

void expect_keyframes_met(const CubicPath& path, const Shot& shot) {
  for (const motion::Keyframe& keyframe : shot.plan().keyframes) {
    const motion::Pose pose = path.pose(keyframe.time_s);
    EXPECT_LE((pose.position - keyframe.pose.position).norm(), kSame);
    EXPECT_LE(pose.orientation.angularDistance(keyframe.pose.orientation), 4.0 * kSame);
  }
}

TEST(Shot, ComparesByTheScaleOfPlanning) {
  Random random(2);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(true);
  for (int i = 0; i < 5; ++i) {
    const BenchRequest request = request_of(curved_flight(random));
    const Shot shot(*scene, request, 5.0);
    const planning::PlanResult result = planning::plan(*scene, shot.plan());
    ASSERT_TRUE(result.frame && result.measures);
    const CubicPath path = motion::interpolate_cubic(result.keyframes, *result.frame);
    const correction::Shift shift =
        correction::shift_of(path, shot.interpolated(), shot.closeness());
    EXPECT_NEAR(shift.largest_rad, result.measures->largest_shift_rad, kSame);
    EXPECT_NEAR(shift.mean_rad, result.measures->mean_shift_rad, kSame);
  }
}

TEST(BestKnown, IsThePathAsInterpolatedWhereNothingIsInTheWay) {
  Random random(1);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(false);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 1.0);
  motion::BumpRow row{motion::KnotRow(4.0, 6.0, 4), 2, {{{0.1, 0.2, 0.3}, {0.0, 0.02, 0.0, 0.01}}}};
  const CubicPath start = motion::with_bumps(shot.interpolated(), std::span(&row, 1));
  const std::optional<Answer> best = best_known(shot, std::span(&start, 1), {.seconds = 1.0});
  ASSERT_TRUE(best && best->is_proved());
  EXPECT_LE(shot.cost(best->cubic), 0.05 * shot.cost(start));
  expect_keyframes_met(best->cubic, shot);
}

TEST(BestKnown, IsProvedFreeAndCostsLessThanTheAnswer) {
  Random random(2);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(true);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 5.0);
  ASSERT_GT(shot.collisions(), 0U);
  const Answer answer = planned(shot, shot.plan().options);
  ASSERT_TRUE(answer.is_proved());
  const std::optional<Answer> best =
      best_known(shot, std::span(&answer.cubic, 1), {.seconds = 1.0});
  ASSERT_TRUE(best && best->is_proved());
  EXPECT_LT(shot.cost(best->cubic), shot.cost(answer.cubic));
  EXPECT_TRUE(shot.certified_clearance_m(best->path));
  expect_keyframes_met(best->cubic, shot);
}

TEST(BestKnown, KeepsTheClearanceThatIsAskedFor) {
  Random random(2);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(true);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 5.0);
  const Answer answer = planned(shot, shot.plan().options);
  ASSERT_TRUE(answer.is_proved());
  const double clearance_m = 0.9 * *answer.clearance_m;
  const std::optional<Answer> best =
      best_known(shot, std::span(&answer.cubic, 1), {.seconds = 0.5, .clearance_m = clearance_m});
  ASSERT_TRUE(best && best->is_proved());
  // The certificate is a lower bound, which may be a fifth below the clearance that is kept.
  EXPECT_GE(*best->clearance_m, 0.8 * clearance_m);
  const std::optional<Answer> nothing =
      best_known(shot, std::span(&answer.cubic, 1), {.seconds = 0.5, .clearance_m = 10.0});
  EXPECT_FALSE(nothing);
}

TEST(BestKnown, StartsFromOtherAnswersThanTheDefault) {
  Random random(2);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(true);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 5.0);
  const Answer answer = planned(shot, shot.plan().options);
  int different = 0;
  for (const Answer& other : other_answers(shot)) {
    EXPECT_TRUE(shot.certified_clearance_m(other.path));
    different += shot.cost(other.cubic) == shot.cost(answer.cubic) ? 0 : 1;
  }
  EXPECT_GT(different, 0);
}

TEST(OtherSides, AreFreeAndMeetTheKeyframes) {
  Random random(2);
  const std::shared_ptr<const scene::Snapshot> scene = scene_of(true);
  const BenchRequest request = request_of(curved_flight(random));
  const Shot shot(*scene, request, 5.0);
  const Answer answer = planned(shot, shot.plan().options);
  const std::vector<CubicPath> others = other_sides(shot, answer.cubic);
  EXPECT_FALSE(others.empty());
  for (const CubicPath& other : others) {
    EXPECT_TRUE(shot.certified_clearance_m(other.path()));
    expect_keyframes_met(other, shot);
    const double aside_m = (other.at(5.0).position - answer.cubic.at(5.0).position).norm();
    EXPECT_GT(aside_m, 0.1);
  }
}

}  // namespace
}  // namespace camway::bench
