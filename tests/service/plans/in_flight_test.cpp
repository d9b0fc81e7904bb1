// SPDX-License-Identifier: MIT
#include "daemon/service/plans/in_flight.h"

#include <gtest/gtest.h>

#include <limits>

namespace camway::service {
namespace {

using std::chrono::milliseconds;

const RequestKey kKey{"tester", 3};

TEST(InFlight, CancelStopsTheDeadlineOfThatRequestAlone) {
  InFlight flights;
  const RequestKey other{"tester", 4};
  const base::Deadline deadline = flights.begin(kKey, 10.0, 0.0);
  const base::Deadline other_deadline = flights.begin(other, 10.0, 0.0);
  EXPECT_FALSE(flights.cancelled(kKey));
  EXPECT_TRUE(flights.cancel(kKey));
  EXPECT_TRUE(flights.cancel(kKey)) << "twice is as good as once";
  EXPECT_TRUE(flights.cancelled(kKey));
  EXPECT_TRUE(deadline.passed());
  EXPECT_FALSE(flights.cancelled(other));
  EXPECT_FALSE(other_deadline.passed());
  flights.end(kKey);
  EXPECT_FALSE(flights.cancel(kKey));
  EXPECT_FALSE(flights.cancelled(kKey));
}

TEST(InFlight, TellsWhatPlanningReported) {
  InFlight flights;
  const base::Deadline deadline = flights.begin(kKey, 10.0, 0.5);
  const InFlight::Clock::time_point due = flights.next_due();
  EXPECT_TRUE(flights.take_due(due - milliseconds(1)).empty());
  std::vector<plan_progress_t> told = flights.take_due(due);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].stage, plan_progress_t::WAITING);
  EXPECT_EQ(told[0].deadline_s, 10.0);
  deadline.report(base::Progress::Stage::kCorrecting);
  deadline.report_collisions(5, 2);
  EXPECT_EQ(flights.next_due(), due + milliseconds(500));
  told = flights.take_due(flights.next_due());
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].client_id, "tester");
  EXPECT_EQ(told[0].request_id, 3);
  EXPECT_EQ(told[0].stage, plan_progress_t::CORRECTING);
  EXPECT_EQ(told[0].num_collisions, 5);
  EXPECT_EQ(told[0].num_corrected, 2);
  flights.end(kKey);
  EXPECT_EQ(flights.next_due(), InFlight::Clock::time_point::max());
}

TEST(InFlight, StrangePeriodsDoNoHarm) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double never : {0.0, -1.0, -kInfinity, kNan}) {
    InFlight flights;
    (void)flights.begin(kKey, 10.0, never);
    EXPECT_EQ(flights.next_due(), InFlight::Clock::time_point::max()) << never;
  }
  for (const double period_s : {1e-300, 1e-3, kInfinity}) {
    InFlight flights;
    const InFlight::Clock::time_point before = InFlight::Clock::now();
    (void)flights.begin(kKey, 10.0, period_s);
    EXPECT_GE(flights.next_due(), before + InFlight::kLeastPeriod) << period_s;
  }
}

}  // namespace
}  // namespace camway::service
