// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string>

#include "daemon/messages/plan.h"
#include "daemon/messages/text.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/messages/plan_samples.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using Result = planning::PlanResult;
using Edit = std::function<void(Result&)>;

RecordedRequest request_for(correction::Objective objective = correction::Objective::kShortest) {
  RecordedRequest recorded;
  recorded.request = simple_request({{0, 0, 0}, {1, 0, 0}, {2, 1, 0}});
  recorded.request->options.objective = objective;
  return recorded;
}

/// Returns a proved answer with measures.
Result proved_result() {
  Result result;
  result.status = planning::Status::kOk;
  result.keyframes = request_for().request->keyframes;
  for (std::size_t i = 0; i < result.keyframes.size(); ++i) {
    result.keyframes[i].time_s = static_cast<double>(i);
  }
  result.path = motion::interpolate(result.keyframes);
  result.certificate = {true, 0.5};
  result.measures.emplace().length_m = 4.0;
  result.timing.total_ms = 100.0;
  return result;
}

RecordedAnswer answer_of(const Result& result) {
  RecordedAnswer answer;
  answer.result = messages::to_wire(result, {});
  answer.status = messages::status_name(answer.result->status);
  return answer;
}

Judgement judged(const Result& then, const Result& now, const Thresholds& thresholds = {},
                 const RecordedRequest& recorded = request_for()) {
  const RecordedAnswer before = answer_of(then);
  const RecordedAnswer after = answer_of(now);
  return judge(recorded, {&before, &after}, thresholds);
}

/// Returns the verdict on an answer that was edited, and that on the edit being undone.
std::pair<Verdict, Verdict> both_ways(const Edit& edit, const Thresholds& thresholds = {}) {
  const Result then = proved_result();
  Result now = then;
  edit(now);
  return {judged(then, now, thresholds).verdict, judged(now, then, thresholds).verdict};
}

using Both = std::pair<Verdict, Verdict>;

TEST(ReplayVerdict, TheSameBitsAreTheSame) {
  EXPECT_EQ(both_ways([](Result&) {}), Both(Verdict::kSame, Verdict::kSame));
  // Members that tell how the answer was found do not count.
  EXPECT_EQ(both_ways([](Result& now) {
              now.timing.total_ms = 1e6;
              now.message = "other words";
            }),
            Both(Verdict::kSame, Verdict::kSame));
}

TEST(ReplayVerdict, ComparesProvedPathsByTheObjective) {
  EXPECT_EQ(both_ways([](Result& now) { now.measures->length_m = 3.0; }),
            Both(Verdict::kBetter, Verdict::kWorse));
  EXPECT_EQ(both_ways([](Result& now) { now.measures->length_m = 3.999; }),
            Both(Verdict::kDifferent, Verdict::kDifferent))
      << "within the margin";
  const Result then = proved_result();
  Result now = then;
  now.measures->length_m = 3.0;
  now.measures->largest_shift_rad = 0.5;
  now.measures->mean_shift_rad = 0.1;
  EXPECT_EQ(judged(then, now, {}, request_for(correction::Objective::kClosest)).verdict,
            Verdict::kWorse);
  now.near_scale = 0.5;
  EXPECT_EQ(judged(then, now).verdict, Verdict::kWorse) << "shrinking counts before the length";
}

// The default objective counts turns, which no distance of the eye tells of.
TEST(ReplayVerdict, AnAnswerThatOnlyTurnsMoreIsWorse) {
  Result then = proved_result();
  then.measures->largest_shift_rad = 0.1;
  then.measures->mean_shift_rad = std::numbers::pi / 180.0;
  Result now = then;
  now.measures->mean_shift_rad *= 1.5;
  const RecordedRequest closest = request_for(correction::Objective::kClosest);
  const Judgement worse = judged(then, now, {}, closest);
  EXPECT_EQ(worse.verdict, Verdict::kWorse);
  EXPECT_EQ(worse.note, "mean shift 1 -> 1.5° (closest)");
  EXPECT_EQ(judged(now, then, {}, closest).verdict, Verdict::kBetter);
  now.measures->mean_shift_rad = 1.009 * then.measures->mean_shift_rad;
  EXPECT_EQ(judged(then, now, {}, closest).verdict, Verdict::kDifferent) << "within the margin";
}

TEST(ReplayVerdict, AnswersOfVersionsWithoutShiftsAreJudgedByTheirDeviation) {
  Result then = proved_result();
  then.measures->largest_deviation_m = 0.5;
  Result now = then;
  now.measures->largest_deviation_m = 0.4;
  now.measures->largest_shift_rad = 0.2;
  now.measures->mean_shift_rad = 0.1;
  const RecordedRequest closest = request_for(correction::Objective::kClosest);
  const Judgement better = judged(then, now, {}, closest);
  EXPECT_EQ(better.verdict, Verdict::kBetter);
  EXPECT_EQ(better.note, "deviation 0.5 -> 0.4 m (closest)");
  EXPECT_EQ(judged(now, then, {}, closest).verdict, Verdict::kWorse);
}

TEST(ReplayVerdict, AWorseStatusIsARegression) {
  const auto becomes = [](planning::Status status) {
    return [status](Result& now) {
      now.status = status;
      now.certificate = {};
    };
  };
  using planning::Status;
  EXPECT_EQ(both_ways(becomes(Status::kPartial)), Both(Verdict::kRegressed, Verdict::kBetter));
  EXPECT_EQ(both_ways(becomes(Status::kInvalid)), Both(Verdict::kRegressed, Verdict::kDifferent));
  EXPECT_EQ(both_ways(becomes(Status::kInternalError)),
            Both(Verdict::kRegressed, Verdict::kDifferent));
  EXPECT_EQ(both_ways(becomes(Status::kInfeasible)), Both(Verdict::kRegressed, Verdict::kRegressed))
      << "two proofs that contradict each other";
  EXPECT_EQ(both_ways(becomes(Status::kTimeout)), Both(Verdict::kRegressed, Verdict::kNotCompared));
}

TEST(ReplayVerdict, ProofsOfDifferentScenesDoNotContradict) {
  const RecordedAnswer then = answer_of(proved_result());
  Result refuted = proved_result();
  refuted.status = planning::Status::kInfeasible;
  const RecordedAnswer now = answer_of(refuted);
  EXPECT_EQ(judge(request_for(), {&now, &then, false}, {}).verdict, Verdict::kBetter);
  EXPECT_EQ(judge(request_for(), {&now, &then, true}, {}).verdict, Verdict::kRegressed);
}

TEST(ReplayVerdict, PartialAnswersCompareByTheirTimeInCollision) {
  Result then = proved_result();
  then.status = planning::Status::kPartial;
  then.certificate = {};
  then.remaining_collisions = {{0.25, 0.5}, {1.0, 1.25}};
  Result now = then;
  now.remaining_collisions = {{0.25, 0.5}};
  EXPECT_EQ(judged(then, now).verdict, Verdict::kBetter);
  EXPECT_EQ(judged(now, then).verdict, Verdict::kWorse);
  now.certificate.certified = true;  // free, but beyond the motion limits
  now.remaining_collisions.clear();
  EXPECT_EQ(judged(then, now).verdict, Verdict::kBetter);
  EXPECT_EQ(judged(now, then).verdict, Verdict::kRegressed) << "not proved any more";
}

TEST(ReplayVerdict, LimitsMakeRegressions) {
  const auto farther = [](Result& now) { now.certificate.clearance_lower_bound_m = 0.25; };
  EXPECT_EQ(both_ways(farther).first, Verdict::kDifferent);
  EXPECT_EQ(both_ways(farther, {.clearance_loss_m = 0.2}).first, Verdict::kRegressed);
  EXPECT_EQ(both_ways(farther, {.clearance_loss_m = 0.3}).first, Verdict::kDifferent);
  EXPECT_EQ(both_ways(farther, {.clearance_loss_m = 0.2}).second, Verdict::kDifferent);
  const auto longer = [](Result& now) { now.measures->length_m = 5.0; };
  EXPECT_EQ(both_ways(longer, {.longer = 1.2}).first, Verdict::kRegressed);
  EXPECT_EQ(both_ways(longer, {.longer = 1.3}).first, Verdict::kWorse);
  const auto slower = [](Result& now) { now.timing.total_ms = 250.0; };
  EXPECT_EQ(both_ways(slower, {.slower = 2.0}).first, Verdict::kRegressed) << "bits are the same";
  EXPECT_EQ(both_ways(slower, {.slower = 3.0}).first, Verdict::kSame);
  // Below 20 ms the machine's noise decides.
  Result then = proved_result();
  then.timing.total_ms = 0.1;
  Result now = then;
  now.timing.total_ms = 19.0;
  EXPECT_EQ(judged(then, now, {.slower = 2.0}).verdict, Verdict::kSame);
}

TEST(ReplayVerdict, NamesTheLimit) {
  const Result then = proved_result();
  Result now = then;
  now.certificate.clearance_lower_bound_m = 0.25;
  now.measures->length_m = 8.0;
  EXPECT_EQ(judged(then, now, {.clearance_loss_m = 0.0, .longer = 1.0}).note,
            "clearance 0.5 -> 0.25 m, length 4 -> 8 m");
}

TEST(ReplayVerdict, NamesTheMeasureThatDecides) {
  using correction::Objective;
  const auto reason = [](const Edit& edit, Objective objective) {
    const Result then = proved_result();
    Result now = then;
    edit(now);
    return judged(then, now, {}, request_for(objective)).note;
  };
  const Edit measures = [](Result& now) {
    now.measures->length_m = 3.0;
    now.measures->largest_deviation_m = 0.5;
    now.measures->largest_shift_rad = 0.5;
    now.measures->mean_shift_rad = std::numbers::pi / 90.0;
    now.measures->bending_energy_m2_per_s3 = 7.0;
    now.certificate.clearance_lower_bound_m = 0.75;
  };
  EXPECT_EQ(reason(measures, Objective::kShortest), "length 4 -> 3 m (shortest)");
  EXPECT_EQ(reason(measures, Objective::kClosest), "mean shift 0 -> 2° (closest)");
  EXPECT_EQ(reason(measures, Objective::kSmoothest), "bending energy 0 -> 7 m^2/s^3 (smoothest)");
  EXPECT_EQ(reason([](Result& now) { now.near_scale = 0.5; }, Objective::kShortest),
            "share of the near distance 1 -> 0.5");
  Result then = proved_result();
  then.status = planning::Status::kPartial;
  then.certificate = {};
  then.remaining_collisions = {{0.25, 0.5}, {1.0, 1.25}};
  Result now = then;
  now.remaining_collisions = {{0.25, 0.5}};
  EXPECT_EQ(judged(then, now).note, "time in collision 0.5 -> 0.25 s");
}

TEST(ReplayVerdict, PathsWithinTheTolerancesAreTheSame) {
  const Result then = proved_result();
  Result now = then;
  constexpr double kMoved_m = 1e-3;
  now.keyframes[1].pose.position.z() += kMoved_m;
  now.path = motion::interpolate(now.keyframes);
  EXPECT_EQ(judged(then, now).verdict, Verdict::kDifferent);
  EXPECT_EQ(judged(then, now, {.tolerance_m = 2e-3}).verdict, Verdict::kSame);
  EXPECT_EQ(judged(then, now, {.tolerance_m = 0.5e-3}).verdict, Verdict::kDifferent);
  EXPECT_EQ(judged(then, now, {.tolerance_m = 2e-3, .tolerance_shift_rad = 1e-6}).verdict,
            Verdict::kDifferent);
  now.keyframes.push_back(now.keyframes.back());
  EXPECT_EQ(judged(then, now, {.tolerance_m = 2e-3}).verdict, Verdict::kDifferent)
      << "another number of keyframes";
}

TEST(ReplayVerdict, TheToleranceOfShiftsIsAtTheViewingDistanceOfTheRequestElseOfTheAnswers) {
  Result then = proved_result();
  Result now = then;
  constexpr double kMoved_m = 1e-3;
  now.keyframes[1].pose.position.z() += kMoved_m;
  now.path = motion::interpolate(now.keyframes);
  const Thresholds at_2_m{.tolerance_m = 2.0 * kMoved_m, .tolerance_shift_rad = kMoved_m / 2.0};
  const auto is_same = [&](const RecordedRequest& recorded = request_for()) {
    const Verdict verdict = judged(then, now, at_2_m, recorded).verdict;
    EXPECT_EQ(judged(now, then, at_2_m, recorded).verdict, verdict);
    return verdict == Verdict::kSame;
  };
  EXPECT_TRUE(is_same()) << "3 m where nothing is told";
  now.viewing_distance_m = 1.0;
  EXPECT_FALSE(is_same());
  then.viewing_distance_m = 5.0;
  EXPECT_FALSE(is_same()) << "the smaller one counts";
  now.viewing_distance_m = 5.0;
  EXPECT_TRUE(is_same());
  RecordedRequest asked = request_for();
  asked.request->options.viewing_distance_m = 1.0;
  EXPECT_FALSE(is_same(asked));
}

TEST(ReplayVerdict, NothingIsComparedWithoutTwoAnswers) {
  const RecordedAnswer answer = answer_of(proved_result());
  RecordedAnswer busy;
  busy.status = "overloaded";
  EXPECT_EQ(judge(request_for(), {nullptr, &answer}, {}).note, "no answer in the log");
  EXPECT_EQ(judge(request_for(), {&answer, nullptr}, {}).note, "no answer now");
  EXPECT_EQ(judge(request_for(), {&busy, &answer}, {}).note, "recorded: overloaded");
  EXPECT_EQ(judge(request_for(), {&answer, &busy}, {}).note, "now: overloaded");
}

// Properties over random answers: exchanging them exchanges better and worse.
TEST(ReplayVerdict, IsAntisymmetric) {
  testing::Random random(testing::kSeed);
  std::size_t better = 0;
  for (int trial = 0; trial < 120; ++trial) {
    Result a = testing::sample_result(2, random);
    Result b = testing::below(random, 4) == 0 ? a : testing::sample_result(2, random);
    a.deadline_reached = b.deadline_reached = false;
    b.status = testing::below(random, 2) == 0 ? a.status : b.status;
    const Judgement there = judged(a, b);
    const Judgement back = judged(b, a);
    const bool is_same = there.verdict == Verdict::kSame;
    ASSERT_EQ(is_same, back.verdict == Verdict::kSame) << trial;
    ASSERT_EQ(is_same, there.difference.has_same_bits() && there.verdict != Verdict::kNotCompared)
        << trial;
    ASSERT_FALSE(there.verdict == Verdict::kBetter && back.verdict == Verdict::kBetter) << trial;
    if (there.verdict == Verdict::kWorse) {
      ASSERT_EQ(back.verdict, Verdict::kBetter) << trial;
    }
    if (there.verdict == Verdict::kBetter) {
      ++better;
      ASSERT_TRUE(back.verdict == Verdict::kWorse || back.verdict == Verdict::kRegressed) << trial;
    }
  }
  EXPECT_GT(better, 5U);
}

}  // namespace
}  // namespace camway::tools
