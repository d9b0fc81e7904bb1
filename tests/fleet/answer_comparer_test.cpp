// SPDX-License-Identifier: MIT
#include "daemon/fleet/answer_comparer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "daemon/messages/plan.h"
#include "tests/messages/plan_samples.h"

namespace camway::fleet {
namespace {

plan_response_t some_answer() {
  testing::Random random(testing::kSeed);
  planning::PlanResult result = testing::sample_result(4, random);
  result.status = planning::Status::kOk;
  result.deadline_reached = false;
  return messages::to_wire(result, {{"client", 7, 1}, "room", 3, "digest"});
}

TEST(AnswerComparer, DiffersByAnyBitButTimes) {
  const plan_response_t answer = some_answer();
  const AnswerMark mark = mark_of(answer, "a");
  plan_response_t other = answer;
  other.utime = 99;
  other.total_ms += 1.0;
  EXPECT_FALSE(differ(mark, mark_of(other, "b")));
  other.segments[1].position_m[2][1] = std::nextafter(other.segments[1].position_m[2][1], 1e9);
  EXPECT_TRUE(differ(mark, mark_of(other, "b")));
}

TEST(AnswerComparer, ComparesOnlyWhatMustBeEqual) {
  const plan_response_t answer = some_answer();
  const AnswerMark mark = mark_of(answer, "a");
  plan_response_t other = answer;
  other.message += "!";
  ASSERT_TRUE(differ(mark, mark_of(other, "b")));
  plan_response_t cut = other;
  cut.deadline_reached = 1;
  EXPECT_FALSE(differ(mark, mark_of(cut, "b")));
  cut = other;
  cut.status = plan_response_t::STATUS_TIMEOUT;
  EXPECT_FALSE(differ(mark_of(cut, "b"), mark));
  cut.status = plan_response_t::STATUS_CANCELLED;
  EXPECT_FALSE(differ(mark_of(cut, "b"), mark));
  cut = other;
  cut.scene_revision = 4;
  EXPECT_FALSE(differ(mark, mark_of(cut, "b")));
  cut = other;
  cut.scene_digest = "other";
  EXPECT_FALSE(differ(mark, mark_of(cut, "b")));
}

TEST(AnswerMemory, KeepsAFewHundredForAMinute) {
  AnswerMemory memory;
  const AnswerMark mark = mark_of(some_answer(), "a");
  const auto begin = AnswerMemory::Clock::now();
  for (std::int64_t job = 0; job < 1000; ++job) memory.keep(job, mark, begin);
  EXPECT_EQ(memory.size(), AnswerMemory::kMost);
  EXPECT_EQ(memory.find(743, begin), nullptr);
  ASSERT_NE(memory.find(744, begin), nullptr);
  EXPECT_EQ(memory.find(999, begin)->planner, "a");
  EXPECT_NE(memory.find(999, begin + std::chrono::milliseconds(59'999)), nullptr);
  EXPECT_EQ(memory.find(999, begin + std::chrono::seconds(60)), nullptr);
  EXPECT_EQ(memory.size(), 0U);
}

}  // namespace
}  // namespace camway::fleet
