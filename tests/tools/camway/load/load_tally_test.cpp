// SPDX-License-Identifier: MIT
#include "tools/camway/load/load_tally.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <random>

#include "tests/messages/plan_samples.h"
#include "tests/support/random.h"

namespace camway::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

constexpr std::uint32_t kTallySeed = 2006;

/// Returns the daemon's answer as the client reads it.
PlanResponse answer_of(const planning::PlanResult& result) {
  PlanResponse answer;
  answer.status = Status::kOk;
  std::vector<Segment> segments;
  for (const motion::Segment& from : result.path.segments()) {
    Segment to;
    to.t0_s = from.t0_s;
    to.t1_s = from.t1_s;
    for (std::size_t i = 0; i < 4; ++i) {
      std::copy_n(from.position[i].data(), 3, to.position_m[i].begin());
    }
    for (std::size_t i = 0; i < 7; ++i) {
      std::copy_n(from.orientation[i].data(), 4, to.orientation_wxyz[i].begin());
    }
    segments.push_back(to);
  }
  answer.path = Path(std::move(segments));
  for (const motion::Keyframe& from : result.keyframes) {
    const geometry::Vec3& p = from.pose.position;
    answer.keyframes.push_back(
        {from.time_s, {p.x(), p.y(), p.z()}, {}, from.origin == motion::KeyframeOrigin::kInserted});
  }
  for (const auto& c : result.collisions) answer.collisions.push_back({c.t_begin_s, c.t_end_s, {}});
  for (const auto& c : result.remaining_collisions) {
    answer.remaining.push_back({c.t_begin_s, c.t_end_s, {}});
  }
  answer.certified = result.certificate.certified;
  answer.clearance_lower_bound_m = result.certificate.clearance_lower_bound_m;
  return answer;
}

class LoadTallyTest : public ::testing::Test {
 protected:
  LoadTallyTest() {
    camway::testing::Random random(kTallySeed);
    sent_.name = "q.json";
    sent_.expected = camway::testing::sample_result(5, random);
    sent_.expected.status = planning::Status::kOk;
  }

  LoadRequest sent_;
};

TEST_F(LoadTallyTest, TheSameBitsAreExpectedAndNothingElse) {
  const PlanResponse good = answer_of(sent_.expected);
  EXPECT_TRUE(is_expected(sent_.expected, good));
  const auto changed = [&](const std::function<void(PlanResponse&)>& change) {
    PlanResponse answer = good;
    change(answer);
    return is_expected(sent_.expected, answer);
  };
  const auto change_segment = [](PlanResponse& answer, const std::function<void(Segment&)>& how) {
    std::vector<Segment> segments = answer.path.segments();
    how(segments[2]);
    answer.path = Path(std::move(segments));
  };
  const auto nudge = [](double& value) { value = std::nextafter(value, 1e300); };
  EXPECT_FALSE(changed([](auto& a) { a.status = Status::kPartial; }));
  EXPECT_FALSE(changed([](auto& a) { a.path = {}; }));
  EXPECT_FALSE(
      changed([&](auto& a) { change_segment(a, [&](Segment& s) { nudge(s.position_m[3][2]); }); }));
  EXPECT_FALSE(changed(
      [&](auto& a) { change_segment(a, [&](Segment& s) { nudge(s.orientation_wxyz[6][3]); }); }));
  EXPECT_FALSE(changed([](auto& a) { a.keyframes.pop_back(); }));
  EXPECT_FALSE(changed([](auto& a) { a.keyframes[0].inserted = !a.keyframes[0].inserted; }));
  EXPECT_FALSE(changed([](auto& a) { a.certified = !a.certified; }));
  EXPECT_FALSE(changed([&](auto& a) { nudge(a.clearance_lower_bound_m); }));
  EXPECT_FALSE(changed([](auto& a) { a.remaining.push_back({}); }));
}

TEST_F(LoadTallyTest, CountsWhatBecameOfEachRequest) {
  LoadTally tally;
  PlanResponse answer = answer_of(sent_.expected);
  answer.tries = 3;
  answer.elapsed_s = 0.010;
  answer.timing.total_ms = 8.0;
  tally.add(sent_, answer);
  answer.status = Status::kOverloaded;
  tally.add(sent_, answer);
  answer.status = Status::kPartial;
  tally.add(sent_, answer);
  answer.status = Status::kInvalid;
  answer.error = "keyframes[1] collides";
  tally.add(sent_, answer);
  answer.status = Status::kNoAnswer;
  answer.error = "the daemon fell silent";
  LoadTally other;
  other.add(sent_, answer);
  tally.add(other);
  EXPECT_EQ(tally.asked, 5);
  EXPECT_EQ(tally.answered, 1);
  EXPECT_EQ(tally.refused, 1);
  EXPECT_EQ(tally.wrong, 2);
  EXPECT_EQ(tally.lost, 1);
  EXPECT_EQ(tally.retries, 10);
  EXPECT_EQ(tally.by_status.at("no_answer"), 1);
  EXPECT_THAT(tally.latency_ms, ElementsAre(10.0f));
  EXPECT_THAT(tally.overhead_ms, ElementsAre(2.0f));
  EXPECT_THAT(tally.complaints, ElementsAre(HasSubstr("(partial)"), HasSubstr("(invalid)"),
                                            HasSubstr("fell silent")));
}

TEST_F(LoadTallyTest, NamesInvalidRequestsOnceThoughTheAnswerIsExpected) {
  sent_.expected = {};
  sent_.expected.status = planning::Status::kInvalid;
  PlanResponse answer = answer_of(sent_.expected);
  answer.status = Status::kInvalid;
  answer.error = "keyframes: holds 1; a path needs 2 to 100000";
  LoadTally tally;
  LoadTally other;
  for (int i = 0; i < 3; ++i) tally.add(sent_, answer);
  other.add(sent_, answer);
  tally.add(other);
  EXPECT_EQ(tally.answered, 4);
  EXPECT_EQ(tally.by_status.at("invalid"), 4);
  EXPECT_THAT(tally.invalid, ElementsAre(Pair("q.json", answer.error)));
}

TEST(Percentiles, AreThoseOfTheSortedValues) {
  EXPECT_EQ(percentiles({}).p50, 0.0);
  EXPECT_EQ(percentiles({3.0f}).p999, 3.0);
  std::vector<float> values;
  for (int i = 1; i <= 1000; ++i) values.push_back(static_cast<float>(i));
  std::shuffle(values.begin(), values.end(), testing::Random(kTallySeed));
  const Percentiles p = percentiles(values);
  EXPECT_EQ(p.p50, 500.0);
  EXPECT_EQ(p.p99, 990.0);
  EXPECT_EQ(p.p999, 999.0);
  EXPECT_EQ(p.max, 1000.0);
}

TEST(MemoryGrowth, CountsFromTheEndOfTheWarmUp) {
  std::vector<MemorySample> samples;
  for (int i = 0; i < 100; ++i) {
    samples.push_back({static_cast<double>(i), i < 20 ? 10.0 * i : 200.0});
  }
  EXPECT_GT(memory_growth(samples, 0.0), 1.0);
  EXPECT_EQ(memory_growth(samples, 20.0), 0.0);
  for (int i = 90; i < 100; ++i) samples[static_cast<std::size_t>(i)].resident_mb = 210.0;
  EXPECT_NEAR(memory_growth(samples, 20.0), 0.05, 1e-12);
  samples[95].resident_mb = 1e6;  // one odd sample decides nothing
  EXPECT_NEAR(memory_growth(samples, 20.0), 0.05, 1e-12);
  EXPECT_EQ(memory_growth(samples, 95.0), 0.0) << "too few samples to say";
  EXPECT_EQ(memory_growth({}, 0.0), 0.0);
}

TEST(ResidentMemory, IsThatOfTheProcess) {
  const double before_mb = resident_mb(getpid());
  EXPECT_GT(before_mb, 1.0);
  const std::vector<char> held(64'000'000, 'x');
  EXPECT_GT(resident_mb(getpid()), before_mb + 50.0) << held.back();
  EXPECT_EQ(resident_mb(0), 0.0);
}

}  // namespace
}  // namespace camway::tools
