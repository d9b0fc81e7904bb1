// SPDX-License-Identifier: MIT
#include "daemon/fleet/planner_board.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace camway::fleet {
namespace {

using Outlook = PlannerBoard::Outlook;
using Return = PlannerBoard::Return;
using std::chrono::milliseconds;

/// A board with a clock that the test turns, and planners that say what it wants.
class PlannerBoardTest : public ::testing::Test {
 protected:
  void say(const std::string& id, int workers, int running, std::int64_t position = 5,
           std::int64_t start = 1) {
    planner_status_t status{};
    status.planner_id = id;
    status.start_id = start;
    status.utime = ++utime_;
    status.serial = ++serial_;
    status.host = "host";
    status.pid = 42;
    status.version = version_;
    status.workers = workers;
    status.running = running;
    status.log_position = position;
    status.is_leaving = is_leaving_ ? 1 : 0;
    last_ = status;
    board_.note(status);
  }
  std::string taken(std::int64_t position = 5) {
    const PlannerBoard::Choice choice = board_.take(position);
    return choice.outlook == Outlook::kTaken ? choice.planner.id : "";
  }
  void pass(milliseconds time) { now_ += time; }

  PlannerBoard::Clock::time_point now_ = PlannerBoard::Clock::now();
  PlannerBoard board_{"v", [this] { return now_; }};
  planner_status_t last_{};
  std::string version_ = "v";
  bool is_leaving_ = false;
  std::int64_t utime_ = 0;
  std::int64_t serial_ = 0;
};

TEST_F(PlannerBoardTest, TakesTheOneWithTheMostFreeSlots) {
  EXPECT_EQ(board_.take(0).outlook, Outlook::kNone);
  say("b", 2, 0);
  say("c", 4, 1);
  say("a", 2, 0);
  EXPECT_EQ(board_.free_slots(), 7);
  EXPECT_EQ(board_.capacity(), 7);
  EXPECT_EQ(taken(), "c");
  EXPECT_EQ(taken(), "a") << "of those with two, by id";
  EXPECT_EQ(taken(), "b");
  EXPECT_EQ(taken(), "c");
  EXPECT_EQ(taken(), "a");
  EXPECT_EQ(taken(), "b");
  EXPECT_EQ(taken(), "c");
  EXPECT_EQ(board_.take(5).outlook, Outlook::kBusy);
  EXPECT_EQ(board_.capacity(), 7) << "own jobs take nothing away";
  board_.give_back({"b", 1}, Return::kEnded);
  EXPECT_EQ(taken(), "b");
}

TEST_F(PlannerBoardTest, GivesPlannersOfAnotherVersionNoJobs) {
  version_ = "w";
  say("new", 4, 0);
  EXPECT_EQ(board_.take(0).outlook, Outlook::kNone) << "the front plans by itself";
  EXPECT_EQ(board_.capacity(), 0);
  ASSERT_EQ(board_.planners(0).size(), 1U);
  EXPECT_EQ(board_.planners(0)[0].is_other_version, 1);
  version_ = "v";
  say("old", 1, 0);
  EXPECT_EQ(taken(), "old");
  EXPECT_EQ(board_.take(0).outlook, Outlook::kBusy);
}

TEST_F(PlannerBoardTest, CountsItsOwnJobsBetweenStatusesAndThoseOfOthers) {
  say("a", 4, 1);  // of another front
  ASSERT_EQ(taken(), "a");
  ASSERT_EQ(taken(), "a");
  EXPECT_EQ(board_.free_slots(), 1);
  say("a", 4, 3);  // the same three
  EXPECT_EQ(board_.free_slots(), 1);
  EXPECT_EQ(board_.capacity(), 3);
  say("a", 4, 1);  // the other front's ended, and one of ours was not yet counted
  EXPECT_EQ(board_.free_slots(), 2);
  EXPECT_EQ(board_.capacity(), 4);
  say("a", 4, 9);  // one that lies
  EXPECT_EQ(board_.free_slots(), 0);
  EXPECT_EQ(board_.capacity(), 1) << "a planner lives";
}

TEST_F(PlannerBoardTest, TakesNoneThatIsSilentOrBehindOrLeaves) {
  say("a", 1, 0, 5);
  EXPECT_EQ(board_.take(6).outlook, Outlook::kBehind);
  EXPECT_EQ(board_.take(5, {{"a", 1}}).outlook, Outlook::kBehind) << "to be avoided";
  EXPECT_EQ(board_.take(5, {{"a", 2}}).outlook, Outlook::kTaken) << "that is another start";
  board_.give_back({"a", 1}, Return::kEnded);
  pass(milliseconds(999));
  EXPECT_FALSE(board_.is_lost({"a", 1}));
  EXPECT_EQ(board_.capacity(), 1);
  pass(milliseconds(1));
  EXPECT_TRUE(board_.is_lost({"a", 1}));
  EXPECT_EQ(board_.take(5).outlook, Outlook::kNone);
  EXPECT_EQ(board_.capacity(), 0);
  EXPECT_EQ(board_.free_slots(), 0);
  say("a", 1, 0);
  EXPECT_FALSE(board_.is_lost({"a", 1})) << "it was only slow";
  is_leaving_ = true;
  say("a", 1, 0);
  EXPECT_FALSE(board_.is_lost({"a", 1})) << "it finishes what it has";
  EXPECT_EQ(board_.take(5).outlook, Outlook::kNone);
  EXPECT_EQ(board_.capacity(), 0);
  say("a", 0, 0);
  EXPECT_TRUE(board_.is_lost({"a", 1})) << "gone, at once";
  EXPECT_TRUE(board_.planners(0).empty());
}

TEST_F(PlannerBoardTest, AsksNoneThatRefusedBeforeItsNextStatus) {
  say("a", 2, 0);
  ASSERT_EQ(taken(), "a");
  board_.give_back({"a", 1}, Return::kRefused);
  EXPECT_EQ(board_.take(5).outlook, Outlook::kBusy);
  EXPECT_EQ(board_.free_slots(), 0);
  say("b", 1, 0);
  EXPECT_EQ(taken(), "b");
  say("a", 2, 0);
  EXPECT_EQ(taken(), "a");
}

TEST_F(PlannerBoardTest, KnowsStartsAndOldStatuses) {
  say("a", 2, 0);
  const planner_status_t first = last_;
  ASSERT_EQ(taken(), "a");
  say("a", 2, 0, 5, 2);
  EXPECT_TRUE(board_.is_lost({"a", 1})) << "started anew";
  EXPECT_EQ(board_.free_slots(), 2) << "what the start before had is nothing to this one";
  ASSERT_EQ(taken(), "a");
  board_.give_back({"a", 1}, Return::kEnded);
  EXPECT_EQ(board_.free_slots(), 1) << "of another start";
  board_.note(first);
  EXPECT_FALSE(board_.is_lost({"a", 2})) << "a late status of the start before";
  const planner_status_t second = last_;
  pass(milliseconds(900));
  board_.note(second);
  pass(milliseconds(200));
  EXPECT_TRUE(board_.is_lost({"a", 2})) << "an old status is no sign of life";
  board_.note(first);
  EXPECT_FALSE(board_.is_lost({"a", 1})) << "clocks may differ, but it is the only one";
}

TEST_F(PlannerBoardTest, TellsItsListenerOfEachChangeOfTheCapacity) {
  std::vector<int> told;
  board_.on_change([&](int capacity) { told.push_back(capacity); });
  say("a", 2, 0);
  say("a", 2, 0);
  say("b", 1, 0);
  say("b", 1, 1);
  board_.tick();
  pass(milliseconds(1000));
  EXPECT_EQ(told, (std::vector<int>{0, 2, 3, 2}));
  board_.tick();
  EXPECT_EQ(told.back(), 0) << "a tick finds who is silent";
  board_.on_change({});
  say("a", 2, 0);
  EXPECT_EQ(told.size(), 5U);
}

TEST_F(PlannerBoardTest, ListsPlannersAndForgetsThem) {
  say("b", 2, 1, 7);
  say("a", 1, 0, 6);
  ASSERT_EQ(taken(7), "b");
  pass(milliseconds(300));
  const auto list = board_.planners(7);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].id, "a");
  EXPECT_EQ(list[0].is_behind, 1);
  EXPECT_EQ(list[1].id, "b");
  EXPECT_EQ(list[1].is_behind, 0);
  EXPECT_EQ(list[1].workers, 2);
  EXPECT_EQ(list[1].running, 1);
  EXPECT_EQ(list[1].host, "host");
  EXPECT_EQ(list[1].pid, 42);
  EXPECT_EQ(list[1].version, "v");
  EXPECT_DOUBLE_EQ(list[1].silent_s, 0.3);
  pass(std::chrono::seconds(60));
  EXPECT_TRUE(board_.planners(7).empty());
  for (int i = 0; i < 2000; ++i) {
    pass(milliseconds(1));
    say("p" + std::to_string(i), 1, 0);
  }
  EXPECT_EQ(board_.planners(0).size(), PlannerBoard::kMostPlanners);
}

TEST_F(PlannerBoardTest, WakesWhoWaits) {
  std::atomic<bool> is_awake = false;
  std::thread waiting([&] {
    board_.wait(std::chrono::seconds(30));
    is_awake = true;
  });
  while (!is_awake) {
    say("a", 1, 0);
    std::this_thread::sleep_for(milliseconds(1));
  }
  waiting.join();
}

}  // namespace
}  // namespace camway::fleet
