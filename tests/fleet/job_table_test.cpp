// SPDX-License-Identifier: MIT
#include "daemon/fleet/job_table.h"

#include <gtest/gtest.h>

namespace camway::fleet {
namespace {

std::shared_ptr<RunningJob> job_of_front(const std::string& front, std::int64_t number) {
  auto job = std::make_shared<RunningJob>();
  job->front = front;
  job->number = number;
  return job;
}

TEST(JobTable, AJobRunsThenHasAnAnswerThenIsForgotten) {
  JobTable table;
  const auto now = JobTable::Clock::now();
  table.begin(job_of_front("f", 1));
  table.begin(job_of_front("g", 1));
  EXPECT_EQ(table.num_running(), 2U);
  EXPECT_TRUE(table.running({"f", 1}));
  EXPECT_FALSE(table.answer({"f", 1}));
  table.end({"f", 1}, std::make_shared<const Bytes>(Bytes{1, 2}), now);
  EXPECT_EQ(table.num_running(), 1U);
  EXPECT_FALSE(table.running({"f", 1}));
  ASSERT_TRUE(table.answer({"f", 1}));
  EXPECT_EQ(*table.answer({"f", 1}), (Bytes{1, 2}));
  EXPECT_EQ(table.bytes(), 2U);
  table.end({"g", 1}, nullptr, now + std::chrono::seconds(60));
  EXPECT_TRUE(table.knows({"g", 1})) << "a job that was cancelled does not run again";
  EXPECT_FALSE(table.answer({"g", 1}));
  EXPECT_FALSE(table.knows({"f", 1})) << "after a minute";
  EXPECT_EQ(table.bytes(), 0U);
  EXPECT_EQ(table.num_running(), 0U);
}

TEST(JobTable, KeepsToItsLimits) {
  JobTable table({3, 100, std::chrono::seconds(60)});
  const auto now = JobTable::Clock::now();
  for (std::int64_t number = 0; number < 5; ++number) {
    table.begin(job_of_front("f", number));
    table.end({"f", number}, std::make_shared<const Bytes>(Bytes(10)), now);
  }
  EXPECT_FALSE(table.knows({"f", 1}));
  EXPECT_TRUE(table.knows({"f", 2}));
  table.begin(job_of_front("f", 9));
  table.end({"f", 9}, std::make_shared<const Bytes>(Bytes(95)), now);
  EXPECT_FALSE(table.knows({"f", 4}));
  EXPECT_EQ(table.bytes(), 95U);
  table.begin(job_of_front("f", 10));
  table.forget({"f", 10});
  EXPECT_FALSE(table.knows({"f", 10}));
  table.forget({"f", 9});
  EXPECT_TRUE(table.knows({"f", 9})) << "it has ended";
}

}  // namespace
}  // namespace camway::fleet
