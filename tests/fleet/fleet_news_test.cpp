// SPDX-License-Identifier: MIT
#include "daemon/fleet/fleet_news.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/captured_log.h"

namespace camway::fleet {
namespace {

using namespace std::chrono_literals;
using Reason = PlannerLoss::Reason;

class FleetNewsTest : public ::testing::Test {
 protected:
  void lose(const std::string& planner, Reason reason, bool is_bus_heard) {
    news_.planner_lost({reason, planner, "client", 7, is_bus_heard}, now_);
  }
  void SetUp() override {
    pass(3s, 3);
    EXPECT_EQ(told(), "info planners plan planners=3\n");
  }
  /// Lets time pass, as a front does.
  void pass(std::chrono::milliseconds time, int planners) {
    for (const auto end = now_ + time; now_ < end; now_ += 100ms) news_.tick(planners, now_);
  }
  /// Returns the lines since the last call.
  std::string told() {
    std::string text = log_.text();
    log_.clear();
    return text;
  }

  testing::CapturedLog log_;
  FleetNews news_{log_.log()};
  FleetNews::Clock::time_point now_ = FleetNews::Clock::time_point{} + 1h;
};

TEST_F(FleetNewsTest, ALostConnectionIsOneLineAndTheOtherOneCountsPlanners) {
  news_.connection_lost(now_);
  for (const char* const planner : {"a", "b", "c"}) lose(planner, Reason::kSilent, false);
  pass(10s, 0);
  EXPECT_EQ(told(), "warning the servers of the fleet cannot be reached; trying again\n");
  news_.connection_made(now_);
  lose("a", Reason::kSilent, false);
  pass(10s, 3);
  EXPECT_EQ(told(), "info connected to the fleet again planners=3\n");
}

TEST_F(FleetNewsTest, SilentPlannersAreNotNamedIfTheConnectionIsFoundLostLater) {
  for (int request = 0; request < 10; ++request) {
    lose("a", Reason::kSilent, false);
    lose("b", Reason::kNotTaken, true);
  }
  pass(3s, 0);
  EXPECT_EQ(told(), "");
  news_.connection_lost(now_);
  pass(10s, 0);
  EXPECT_EQ(told(), "warning the servers of the fleet cannot be reached; trying again\n");
}

TEST_F(FleetNewsTest, PlannersThatAreAllSilentAreOneLine) {
  for (const char* const planner : {"a", "b", "c", "a", "b"}) lose(planner, Reason::kSilent, false);
  pass(10s, 0);
  EXPECT_EQ(told(),
            "warning no planner is heard; requests are planned by this process\n"
            "warning planners are lost to requests planners=3\n");
  pass(10s, 1);
  EXPECT_EQ(told(), "info planners plan planners=1\n");
  news_.planner_heard("a");
  lose("a", Reason::kSilent, false);
  pass(10s, 1);
  EXPECT_EQ(told(),
            "warning a planner is lost to a request planner=a client=client request=7 "
            "reason=\"it was not heard\"\n");
}

TEST_F(FleetNewsTest, APlannerThatIsLostAloneIsNamedAtOnceAndOnce) {
  lose("a", Reason::kSilent, true);
  lose("a", Reason::kSilent, true);
  EXPECT_THAT(told(), ::testing::HasSubstr("planner=a"));
  lose("b", Reason::kEnded, false);
  EXPECT_THAT(told(), ::testing::HasSubstr("reason=\"it has ended\""));
  lose("a", Reason::kSilent, true);
  EXPECT_EQ(told(), "");
  news_.planner_heard("a");
  lose("a", Reason::kIdle, true);
  EXPECT_THAT(told(), ::testing::HasSubstr("planner=a"));
}

TEST_F(FleetNewsTest, WhatComesAgainEveryFewSecondsDoesNotFillTheLog) {
  for (int round = 0; round < 1200; ++round) {  // an hour
    news_.connection_lost(now_);
    pass(500ms, 0);
    news_.connection_made(now_);
    pass(2500ms, 1);
    lose("a", Reason::kSilent, true);
    news_.planner_heard("a");
  }
  const std::string text = told();
  EXPECT_LT(std::ranges::count(text, '\n'), 600);
  EXPECT_THAT(text, ::testing::HasSubstr("lines left out"));
}

TEST_F(FleetNewsTest, AConnectionThatIsLostAgainAtOnceIsOneLoss) {
  for (int i = 0; i < 5; ++i) {
    news_.connection_lost(now_);
    pass(200ms, 0);
    news_.connection_made(now_);
    pass(1s, 0);
  }
  pass(10s, 2);
  EXPECT_EQ(told(),
            "warning the servers of the fleet cannot be reached; trying again\n"
            "info connected to the fleet again planners=2\n");
}

TEST(PlannerPresence, SaysWhoPlansWhenThatHasChanged) {
  testing::CapturedLog log;
  PlannerPresence presence(log.log());
  PlannerPresence::Clock::time_point now = PlannerPresence::Clock::time_point{} + 1h;
  const auto pass = [&](std::chrono::milliseconds time, int planners) {
    for (const auto end = now + time; now < end; now += 100ms) presence.tick(planners, now);
    std::string text = log.text();
    log.clear();
    return text;
  };
  const std::string none = "warning no planner is heard; requests are planned by this process\n";
  EXPECT_EQ(pass(3s, 0), "");
  EXPECT_EQ(pass(3s, 0), none);
  // Planners that start one by one are counted together.
  EXPECT_EQ(pass(1s, 1), "");
  EXPECT_EQ(pass(3s, 3), "info planners plan planners=3\n");
  EXPECT_EQ(pass(10s, 2), "");
  // One that is started again is no absence.
  EXPECT_EQ(pass(3s, 0), "");
  EXPECT_EQ(pass(10s, 1), "");
  presence.is_said(0);
  EXPECT_EQ(pass(10s, 0), "");
  EXPECT_EQ(pass(3s, 1), "info planners plan planners=1\n");
}

TEST(PlannerPresence, PlannersThatComeAndGoDoNotFillTheLog) {
  testing::CapturedLog log;
  PlannerPresence presence(log.log());
  PlannerPresence::Clock::time_point now = PlannerPresence::Clock::time_point{} + 1h;
  for (const auto end = now + 1h; now < end; now += 100ms) {
    presence.tick(static_cast<int>(now.time_since_epoch() / 5s % 2), now);
  }
  const std::string text = log.text();
  EXPECT_LT(std::ranges::count(text, '\n'), 500);
  EXPECT_THAT(text, ::testing::HasSubstr("lines left out"));
}

}  // namespace
}  // namespace camway::fleet
