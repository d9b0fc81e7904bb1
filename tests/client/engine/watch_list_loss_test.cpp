// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
#include <camway/watch_t.hpp>

#include "client/engine/watch_list.h"
#include "lcmtypes/wire/check.h"
#include "tests/client/engine/watch_list_fixture.h"

namespace camway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing_support::kId;
using testing_support::WatchListTest;
using EventKind = WatchEvent::Kind;

TEST_F(WatchListTest, AsksAgainWhatTheDaemonDoesNotKnowLessAndLessOften) {
  begin();
  for (std::size_t asked = 1; asked < 8; ++asked) {
    report(0, path_state_t::UNKNOWN, 0, 0);
    step_at(seconds(40));
    ASSERT_EQ(calls_.size(), asked + 1);
    finish_call(answer(static_cast<std::int64_t>(asked) + 3));
  }
  report(0, path_state_t::UNKNOWN, 0, 0);
  const Clock::time_point asked = now_;
  while (calls_.size() < 9) step_at(milliseconds(100));
  EXPECT_GT(now_ - asked, seconds(10));
}

TEST_F(WatchListTest, GoesOnTryingWhenNobodyAnswers) {
  step_at({});
  calls_.back()->finish(Outcome::kSilence);
  ASSERT_EQ(events_.size(), 1u);
  EXPECT_EQ(events_[0].kind, EventKind::kLost);
  EXPECT_NE(events_[0].error, "");
  step_at(seconds(1));
  ASSERT_EQ(calls_.size(), 2u);
  finish_call(answer(3));
  EXPECT_EQ(events_.back().kind, EventKind::kAnswer);
}

TEST_F(WatchListTest, RenewsUntilItIsAnsweredAndTellsOnceThatNobodyDoes) {
  begin();
  step_at(seconds(9));
  EXPECT_TRUE(sent().empty());
  step_at(seconds(2));
  ASSERT_EQ(sent_renewals().size(), 1u) << "a third of the lease is over";
  int renewals = 0;
  for (int i = 0; i < 600; ++i) {
    step_at(milliseconds(100));
    renewals += static_cast<int>(sent_renewals().size());
  }
  EXPECT_GT(renewals, 5);
  EXPECT_LT(renewals, 20) << "less and less often";
  EXPECT_EQ(std::count_if(events_.begin(), events_.end(),
                          [](const WatchEvent& event) { return event.kind == EventKind::kLost; }),
            1);
  while (sent_.empty()) step_at(milliseconds(100));
  const std::int64_t id = sent().back().request_id;
  report(100, path_state_t::FREE, 3, 3, id);
  step_at(seconds(1));
  sent();
  step_at(seconds(8));
  EXPECT_TRUE(sent_renewals().empty());
}

TEST_F(WatchListTest, TellsThatALostPathIsWatchedAgain) {
  begin();
  const auto lose = [&] {
    while (events_.back().kind != EventKind::kLost) step_at(milliseconds(100));
    sent();
    while (sent_.empty()) step_at(milliseconds(100));
    return sent().back().request_id;
  };
  watch_report_t nothing_new{};
  nothing_new.client_id = "tester";
  nothing_new.request_id = lose();
  list_.take_report(wire::encode(nothing_new), now_);
  ASSERT_EQ(events_.size(), 3u) << "answer, lost, watched";
  EXPECT_EQ(events_[2].kind, EventKind::kWatched);
  EXPECT_EQ(events_[2].scene_revision, 3);

  report(101, path_state_t::BROKEN, 5, 3, lose());
  ASSERT_EQ(events_.size(), 5u);
  EXPECT_EQ(events_[4].kind, EventKind::kBroken) << "which says as much";

  nothing_new.request_id = lose();
  list_.take_report(wire::encode(nothing_new), now_);
  ASSERT_EQ(events_.size(), 7u);
  EXPECT_EQ(events_[6].kind, EventKind::kWatched);
  EXPECT_EQ(events_[6].scene_revision, 5) << "in which it is broken still";

  report(0, path_state_t::UNKNOWN, 0, 0, lose());
  EXPECT_EQ(events_.size(), 8u) << "it is asked for anew";
  step_at(seconds(1));
  finish_call(answer(6));
  ASSERT_EQ(events_.size(), 9u);
  EXPECT_EQ(events_[8].kind, EventKind::kAnswer);
}

TEST_F(WatchListTest, AsksADaemonThatWasStartedAnewAtOnce) {
  begin();
  step_at(seconds(5));
  EXPECT_TRUE(sent().empty());
  list_.take_heartbeat(up_for(1.0), now_);
  step_at({});
  EXPECT_EQ(sent().size(), 1u);
  list_.take_heartbeat(up_for(2.0), now_ + seconds(1));
  step_at(milliseconds(100));
  EXPECT_TRUE(sent().empty()) << "once";
}

/// Revision that the request of a call asks for at least.
std::int64_t least_revision_of(const Call& call) {
  return wire::decode<plan_request_t>(call.request_messages().front().bytes)
      .message.value()
      .least_revision;
}

TEST_F(WatchListTest, ARestartIsToldOnceAndNoOlderSceneIsAnsweredFor) {
  begin();
  EXPECT_EQ(least_revision_of(*calls_.back()), 0);
  list_.take_heartbeat(up_for(100.0, 1), now_);
  EXPECT_EQ(told(EventKind::kRestarted), 0);
  for (int i = 0; i < 3; ++i) list_.take_heartbeat(up_for(1.0 + i, 2), now_);
  EXPECT_EQ(told(EventKind::kRestarted), 1);
  EXPECT_EQ(events_.back().scene_revision, 3);
  list_.take_heartbeat(up_for(103.0, 1), now_);
  EXPECT_EQ(told(EventKind::kRestarted), 1) << "the two share a prefix";
  report(0, path_state_t::UNKNOWN, 0, 0);
  step_at(seconds(1));
  EXPECT_EQ(least_revision_of(*calls_.back()), 3);
  finish_call(answer(1, plan_response_t::STATUS_OLD_SCENE));
  EXPECT_EQ(events_.back().kind, EventKind::kLost);
  EXPECT_EQ(events_.back().status, Status::kOldScene);
  step_at(seconds(1));
  finish_call(answer(1, plan_response_t::STATUS_OLD_SCENE));
  EXPECT_EQ(told(EventKind::kLost), 1) << "once";
  step_at(seconds(2));
  finish_call(answer(4));
  EXPECT_EQ(events_.back().kind, EventKind::kAnswer);
  EXPECT_EQ(told(EventKind::kAnswer), 2);
}

constexpr std::int32_t kOk = plan_response_t::STATUS_OK;

/// A path of start 1 that is answered at revision 3.
class ForgetfulDaemonTest : public WatchListTest {
 protected:
  void SetUp() override {
    step_at({});
    finish_call(answer(3, kOk, {.start_id = 1}));
    report(100, path_state_t::FREE, 3, 3, 0, 0, 1);
    step_at({});
    sent();
  }
  /// Lets start 2 be heard, which does not know the path.
  void restart() {
    list_.take_heartbeat(up_for(1.0, 2), now_);
    ASSERT_EQ(told(EventKind::kRestarted), 1);
    report(0, path_state_t::UNKNOWN, 0, 0, 0, 0, 2);
    step_at(seconds(1));
  }
  /// Expects that the path is lost for good, though start 2 answers with a proof at that revision.
  void stays_lost_at(std::int64_t revision) {
    finish_call(answer(revision, kOk, {.start_id = 2}));
    report(200, path_state_t::FREE, revision, revision, 0, 0, 2);
    list_.take_heartbeat(up_for(60.0, 2, revision), now_);
    step_at(seconds(60));
    EXPECT_EQ(told(EventKind::kLost), 1);
    EXPECT_EQ(told(EventKind::kAnswer), 1) << "the first one";
    EXPECT_EQ(told(EventKind::kFree) + told(EventKind::kWatched), 0);
    EXPECT_EQ(events_.back().status, Status::kOldScene);
  }
};

TEST_F(ForgetfulDaemonTest, TheSameSceneIsAnsweredFor) {
  restart();
  EXPECT_EQ(least_revision_of(*calls_.back()), 3);
  finish_call(answer(3, kOk, {.start_id = 2}));
  EXPECT_EQ(told(EventKind::kAnswer), 2);
  EXPECT_EQ(told(EventKind::kLost), 0);
}

TEST_F(ForgetfulDaemonTest, AnotherSceneOfTheSameRevisionIsLost) {
  restart();
  finish_call(answer(3, kOk, {.start_id = 2, .digest = "other"}));
  EXPECT_EQ(told(EventKind::kLost), 1);
  EXPECT_EQ(told(EventKind::kAnswer), 1);
  EXPECT_NE(events_.back().error.find("watch the path anew"), std::string::npos);
  // The daemon watches it since its answer.
  step_at({});
  const std::vector<watch_t> messages = sent();
  EXPECT_TRUE(
      std::ranges::any_of(messages, [](const watch_t& message) { return message.lease_s < 0.0; }));
}

TEST_F(ForgetfulDaemonTest, ABreakThatWasToldIsNotForgottenWithItsRevision) {
  report(101, path_state_t::BROKEN, 4, 3, 0, 0, 1);
  ASSERT_EQ(told(EventKind::kBroken), 1);
  restart();
  EXPECT_EQ(least_revision_of(*calls_.back()), 4);
  // Its report overtakes its answer.
  report(200, path_state_t::FREE, 4, 3, 0, 0, 2);
  EXPECT_EQ(told(EventKind::kFree), 0);
  stays_lost_at(4);
}

TEST_F(ForgetfulDaemonTest, AnOfferThatWasToldIsNotForgotten) {
  report(101, path_state_t::FREE, 3, 3, 0, 5, 1);
  restart();
  EXPECT_EQ(least_revision_of(*calls_.back()), 5);
  stays_lost_at(6);
}

TEST_F(ForgetfulDaemonTest, ARevisionInAHeartbeatIsNotForgotten) {
  list_.take_heartbeat(up_for(100.0, 1, 6), now_);
  restart();
  EXPECT_EQ(least_revision_of(*calls_.back()), 6);
  finish_call(answer(1, plan_response_t::STATUS_OLD_SCENE, {.start_id = 2}));
  EXPECT_EQ(told(EventKind::kLost), 1);
  step_at(seconds(1));
  stays_lost_at(7);
}

TEST_F(ForgetfulDaemonTest, ADurableSceneGoesOn) {
  report(101, path_state_t::BROKEN, 4, 3, 0, 0, 1);
  restart();
  finish_call(answer(5, kOk, {.start_id = 2, .is_durable = true, .digest = "newer"}));
  EXPECT_EQ(told(EventKind::kAnswer), 2);
  EXPECT_EQ(told(EventKind::kLost), 0);
}

TEST_F(WatchListTest, ThreeMissedHeartbeatsAreToldOnceWithTheReason) {
  begin();
  live(seconds(20), /*beats=*/true);
  EXPECT_EQ(told(EventKind::kLost), 0);
  const Clock::time_point silent_since = now_;
  while (told(EventKind::kLost) == 0) live(milliseconds(50), /*beats=*/false);
  // The last heartbeat may be up to a second old.
  EXPECT_GT(now_ - silent_since, seconds(2));
  EXPECT_LE(now_ - silent_since, milliseconds(3500));
  EXPECT_EQ(events_.back().status, Status::kNoDaemon);
  EXPECT_NE(events_.back().error.find("fell silent"), std::string::npos) << events_.back().error;
  live(seconds(90), /*beats=*/false);
  EXPECT_EQ(told(EventKind::kLost), 1) << "once";
}

TEST_F(WatchListTest, ADaemonThatComesBackIsAskedAtOnceAndToldOnce) {
  begin();
  live(seconds(20), /*beats=*/false);
  ASSERT_EQ(told(EventKind::kLost), 1);
  sent();
  list_.take_heartbeat(up_for(1000.0), now_);
  step_at(milliseconds(50));
  const std::vector<watch_t> renewals = sent();
  ASSERT_EQ(renewals.size(), 1u);
  ASSERT_EQ(renewals[0].num_paths, 1);
  report(100, path_state_t::FREE, 3, 3, renewals[0].request_id);
  EXPECT_EQ(events_.back().kind, EventKind::kWatched);
  live(seconds(5), /*beats=*/true);
  EXPECT_EQ(told(EventKind::kWatched), 1);
  EXPECT_EQ(told(EventKind::kLost), 1);
}

TEST_F(WatchListTest, AnswersToQuestionsCountWhereHeartbeatsDoNotCome) {
  begin();
  std::int64_t asked = 0;
  for (int i = 0; i < 2000; ++i) {
    step_at(milliseconds(50));
    for (const watch_t& message : sent()) {
      ++asked;
      watch_report_t nothing_new{};
      nothing_new.client_id = "tester";
      nothing_new.request_id = message.request_id;
      list_.take_report(wire::encode(nothing_new), now_);
    }
  }
  EXPECT_EQ(told(EventKind::kLost), 0);
  EXPECT_GT(asked, 50);
  EXPECT_LT(asked, 100) << "not each time that it is looked";
}

TEST_F(WatchListTest, TimeInWhichNobodyListenedIsNoSilence) {
  begin();
  live(seconds(5), /*beats=*/true);
  step_at(seconds(9));  // suspended, say, or in a slow handler
  EXPECT_EQ(told(EventKind::kLost), 0);
  list_.take_heartbeat(up_for(1000.0), now_);
  live(seconds(5), /*beats=*/true);
  EXPECT_EQ(told(EventKind::kLost), 0);
}

TEST_F(WatchListTest, ADaemonThatWasNeverHeardIsToldOnce) {
  while (events_.empty()) live(milliseconds(50), /*beats=*/false);
  EXPECT_EQ(events_[0].kind, EventKind::kLost);
  EXPECT_EQ(events_[0].status, Status::kNoDaemon);
  EXPECT_NE(events_[0].error.find("no daemon was heard"), std::string::npos) << events_[0].error;
  for (int i = 0; i < 4; ++i) {
    calls_.back()->finish(Outcome::kSilence);
    live(seconds(20), /*beats=*/false);
  }
  EXPECT_GT(calls_.size(), 2u) << "it is asked for on and on";
  EXPECT_EQ(events_.size(), 1u);
}

}  // namespace
}  // namespace camway
