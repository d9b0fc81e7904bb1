// SPDX-License-Identifier: MIT
#include "client/engine/watch_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include <camway/plan_response_t.hpp>
#include <camway/watch_t.hpp>

#include "lcmtypes/wire/check.h"
#include "tests/client/engine/watch_list_fixture.h"

namespace camway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing_support::kId;
using testing_support::WatchListTest;
using EventKind = WatchEvent::Kind;

TEST_F(WatchListTest, AsksTellsTheAnswerAndSaysWhatItKnows) {
  EXPECT_LE(list_.wake(), now_);
  step_at({});
  ASSERT_EQ(calls_.size(), 1u);
  finish_call(answer(3));
  ASSERT_EQ(events_.size(), 1u);
  EXPECT_EQ(events_[0].kind, EventKind::kAnswer);
  EXPECT_EQ(events_[0].scene_revision, 3);
  ASSERT_TRUE(events_[0].answer);
  EXPECT_TRUE(events_[0].answer->ok()) << events_[0].answer->error;
  report(100, path_state_t::FREE, 3, 3);
  step_at({});
  const std::vector<watch_t> said = sent();
  ASSERT_EQ(said.size(), 1u);
  ASSERT_EQ(said[0].num_paths, 1);
  EXPECT_EQ(said[0].paths[0].request_id, kId);
  EXPECT_EQ(said[0].paths[0].known_serial, 100);
  EXPECT_EQ(said[0].lease_s, 0.0);
  EXPECT_EQ(events_.size(), 1u) << "that a free path is free is no news";
}

TEST_F(WatchListTest, TellsWhatBreaksAndTakesTheCorrectedAnswer) {
  begin();
  report(101, path_state_t::BROKEN, 4, 3);
  report(101, path_state_t::BROKEN, 4, 3);  // twice, as messages may come
  ASSERT_EQ(events_.size(), 2u);
  EXPECT_EQ(events_[1].kind, EventKind::kBroken);
  EXPECT_EQ(events_[1].scene_revision, 4);
  ASSERT_EQ(events_[1].broken.size(), 1u);
  EXPECT_EQ(events_[1].broken[0].t_begin_s, 0.25);
  EXPECT_EQ(events_[1].broken[0].t_end_s, 0.5);
  list_.take_answer(kId, answer(4));
  list_.take_answer(kId, answer(4));
  list_.take_answer(kId, answer(3));  // an old one, late
  ASSERT_EQ(events_.size(), 3u);
  EXPECT_EQ(events_[2].kind, EventKind::kAnswer);
  EXPECT_EQ(events_[2].answer->scene_revision, 4);
  report(102, path_state_t::FREE, 4, 4);
  step_at(seconds(5));
  EXPECT_EQ(events_.size(), 3u);
  EXPECT_EQ(calls_.size(), 1u) << "nothing was missing";
}

TEST_F(WatchListTest, NewsThatACorrectionOvertookIsNone) {
  begin();
  list_.take_answer(kId, answer(4));
  report(101, path_state_t::BROKEN, 4, 3);
  ASSERT_EQ(events_.size(), 2u);
  EXPECT_EQ(events_[1].kind, EventKind::kAnswer);
}

TEST_F(WatchListTest, AsksForACorrectedAnswerThatDoesNotCome) {
  begin();
  report(101, path_state_t::BROKEN, 4, 3);
  report(102, path_state_t::FREE, 4, 4);
  step_at(milliseconds(100));
  EXPECT_EQ(calls_.size(), 1u);
  step_at(seconds(1));
  ASSERT_EQ(calls_.size(), 2u);
  finish_call(answer(4));
  EXPECT_EQ(events_.back().kind, EventKind::kAnswer);
  EXPECT_EQ(events_.back().scene_revision, 4);
}

TEST_F(WatchListTest, TellsThatAPathIsFreeAgain) {
  begin();
  report(101, path_state_t::BROKEN, 4, 3);
  report(102, path_state_t::FREE, 5, 3);
  EXPECT_EQ(events_.back().kind, EventKind::kFree);
  EXPECT_EQ(events_.back().scene_revision, 5);
  report(101, path_state_t::BROKEN, 4, 3);  // overtaken by the other
  EXPECT_EQ(events_.back().kind, EventKind::kFree);
}

TEST_F(WatchListTest, AnUnprovedCorrectionLeavesThePathWatched) {
  begin();
  report(101, path_state_t::BROKEN, 4, 3);
  list_.take_answer(kId, answer(4, plan_response_t::STATUS_INVALID));
  EXPECT_EQ(events_.back().kind, EventKind::kAnswer);
  EXPECT_EQ(events_.back().answer->status, Status::kInvalid);
  report(102, path_state_t::BROKEN, 4, 4);
  EXPECT_EQ(told(EventKind::kBroken), 1) << "the same change";
  report(103, path_state_t::BROKEN, 0, 4);
  EXPECT_EQ(told(EventKind::kBroken), 2) << "the scene is gone";
  report(104, path_state_t::FREE, 5, 4);
  EXPECT_EQ(events_.back().kind, EventKind::kFree);
  report(105, path_state_t::BROKEN, 6, 4);
  EXPECT_EQ(told(EventKind::kBroken), 3) << "it breaks once more";
}

TEST_F(WatchListTest, AFirstAnswerWithoutAProofEndsIt) {
  step_at({});
  finish_call(answer(3, plan_response_t::STATUS_INVALID));
  ASSERT_EQ(events_.size(), 2u);
  EXPECT_EQ(events_[0].kind, EventKind::kAnswer);
  EXPECT_EQ(events_[1].kind, EventKind::kEnded);
  EXPECT_NE(events_[1].error, "");
  EXPECT_EQ(events_[1].status, Status::kInvalid);
  step_at(seconds(100));
  EXPECT_EQ(calls_.size(), 1u);
}

TEST_F(WatchListTest, ABetterPathIsOfferedAndTakenOnlyIfAskedFor) {
  begin();
  report(101, path_state_t::BROKEN, 4, 3);
  list_.take_answer(kId, answer(4));
  report(102, path_state_t::FREE, 4, 4);
  list_.take_offer(kId, answer(5));
  EXPECT_EQ(told(EventKind::kBetter), 0) << "not before it is said to be on offer";
  report(103, path_state_t::FREE, 4, 4, 0, 5);
  report(103, path_state_t::FREE, 4, 4, 0, 5);
  list_.take_offer(kId, answer(5));
  ASSERT_EQ(told(EventKind::kBetter), 1);
  EXPECT_EQ(events_.back().scene_revision, 5);
  EXPECT_TRUE(events_.back().answer->ok());
  const auto taken = [&](const std::vector<watch_t>& messages) {
    std::ptrdiff_t count = 0;
    for (const watch_t& message : messages) {
      for (const watched_path_t& path : message.paths) count += path.taken_offer == 5 ? 1 : 0;
    }
    return count;
  };
  live(seconds(20), /*beats=*/true);
  EXPECT_EQ(taken(sent()), 0) << "it is not forced";

  list_.take_better(kId);
  step_at({});
  EXPECT_EQ(taken(sent()), 1);
  live(seconds(3), /*beats=*/true);
  EXPECT_GE(taken(sent()), 2) << "until it is answered";
  list_.take_answer(kId, answer(5));
  report(104, path_state_t::FREE, 5, 5);
  EXPECT_EQ(events_.back().kind, EventKind::kAnswer);
  EXPECT_EQ(events_.back().scene_revision, 5);
  live(seconds(20), /*beats=*/true);
  EXPECT_EQ(taken(sent()), 0);
  EXPECT_EQ(told(EventKind::kWithdrawn), 0);
}

TEST_F(WatchListTest, TheLostPagesOfAnOfferAreAskedFor) {
  begin();
  report(103, path_state_t::FREE, 4, 3, 0, 5);
  step_at(milliseconds(100));
  EXPECT_EQ(sent().size(), 1u) << "what is known";
  live(seconds(1), /*beats=*/true);
  const std::vector<watch_t> questions = sent();
  ASSERT_FALSE(questions.empty());
  EXPECT_EQ(questions[0].paths.at(0).wanted_offer, 5);
  EXPECT_EQ(questions[0].paths.at(0).taken_offer, 0);
  list_.take_offer(kId, answer(5));
  EXPECT_EQ(told(EventKind::kBetter), 1);
  live(seconds(3), /*beats=*/true);
  EXPECT_TRUE(sent().empty());
}

TEST_F(WatchListTest, AnOfferThatIsWithdrawnIsToldIfItWas) {
  begin();
  report(103, path_state_t::FREE, 5, 3, 0, 5);
  report(104, path_state_t::FREE, 6, 3, 0, 0);
  EXPECT_EQ(told(EventKind::kWithdrawn), 0) << "nobody heard of it";
  report(105, path_state_t::FREE, 7, 3, 0, 7);
  list_.take_offer(kId, answer(7));
  ASSERT_EQ(events_.back().kind, EventKind::kBetter);
  report(106, path_state_t::FREE, 8, 3, 0, 0);
  EXPECT_EQ(events_.back().kind, EventKind::kWithdrawn);
  EXPECT_EQ(events_.back().scene_revision, 8);
  list_.take_better(kId);
  step_at({});
  for (const watch_t& message : sent()) {
    for (const watched_path_t& path : message.paths) EXPECT_EQ(path.taken_offer, 0);
  }
}

TEST_F(WatchListTest, ARefusalIsToldOnceAndTheAnswerAgainOnceItIsWatched) {
  step_at({});
  finish_call(answer(3));
  for (std::size_t asked = 1; asked < 5; ++asked) {
    report(0, path_state_t::REFUSED, 0, 0);
    for (int i = 0; i < 50 && calls_.size() == asked; ++i) step_at(milliseconds(100));
    ASSERT_EQ(calls_.size(), asked + 1) << "it is asked for on and on";
    finish_call(answer(3));
    ASSERT_EQ(events_.size(), 2u) << "the first answer, and that it is not watched";
  }
  EXPECT_EQ(events_[1].kind, EventKind::kLost);
  report(100, path_state_t::FREE, 3, 3);
  ASSERT_EQ(events_.size(), 3u);
  EXPECT_EQ(events_[2].kind, EventKind::kAnswer);
  report(101, path_state_t::BROKEN, 4, 3);
  ASSERT_EQ(events_.size(), 4u);
  EXPECT_EQ(events_[3].kind, EventKind::kBroken);
}

TEST_F(WatchListTest, ARefusalThatOvertakesTheAnswerIsToldAfterIt) {
  step_at({});
  report(0, path_state_t::REFUSED, 0, 0);
  EXPECT_TRUE(events_.empty());
  finish_call(answer(3));
  ASSERT_EQ(events_.size(), 2u);
  EXPECT_EQ(events_[0].kind, EventKind::kAnswer);
  EXPECT_EQ(events_[1].kind, EventKind::kLost);
}

TEST_F(WatchListTest, UnwatchingTellsTheDaemonUntilItAnswers) {
  begin();
  list_.remove(kId);
  step_at({});
  const std::vector<watch_t> said = sent();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_LT(said[0].lease_s, 0.0);
  EXPECT_EQ(said[0].paths.at(0).request_id, kId);
  report(101, path_state_t::BROKEN, 4, 3);
  EXPECT_EQ(events_.size(), 1u);
  step_at(milliseconds(250));
  const std::vector<watch_t> again = sent();
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].request_id, said[0].request_id);
  EXPECT_TRUE(list_.is_ending(kId));
  EXPECT_LT(again[0].lease_s, 0.0);
  step_at(milliseconds(250));
  EXPECT_TRUE(sent().empty()) << "less and less often";
  report(102, path_state_t::BROKEN, 4, 3, said[0].request_id);
  EXPECT_FALSE(list_.is_ending(kId));
  EXPECT_EQ(list_.wake(), Clock::time_point::max());
  step_at(seconds(10));
  EXPECT_TRUE(sent().empty());
}

TEST_F(WatchListTest, UnwatchingIsToldNoLongerThanTheLease) {
  begin();
  list_.remove(kId);
  step_at({});
  step_at(seconds(29));
  EXPECT_EQ(sent().size(), 2u);
  step_at(seconds(1));
  EXPECT_TRUE(sent().empty());
  EXPECT_EQ(list_.wake(), Clock::time_point::max());
}

TEST_F(WatchListTest, UnwatchingBeforeTheAnswerEndsWhatTheAnswerBegins) {
  step_at({});
  list_.remove(kId);
  step_at({});
  report(0, path_state_t::UNKNOWN, 0, 0, sent().at(0).request_id);
  finish_call(answer(3));
  step_at({});
  const std::vector<watch_t> said = sent();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_LT(said[0].lease_s, 0.0);
  EXPECT_TRUE(events_.empty());
}

TEST_F(WatchListTest, WatchingAnewIsNotEndedByAnOldRepetition) {
  begin();
  list_.remove(kId);
  step_at({});
  sent();
  PlanRequest request;
  request.request_id = kId;
  request.keyframes.resize(2);
  list_.add(request, nullptr);
  step_at(seconds(1));
  EXPECT_TRUE(sent().empty());
}

TEST_F(WatchListTest, ManyPathsTakeSeveralMessages) {
  for (std::int64_t id = 1000; id < 8000; ++id) {
    PlanRequest request;
    request.request_id = id;
    request.keyframes.resize(2);
    list_.add(request, nullptr);
  }
  step_at({});
  for (const std::shared_ptr<Call>& call : calls_) {
    plan_response_t page{};
    page.client_id = "tester";
    page.request_id = call->request_id();
    page.num_pages = 1;
    page.certified = 1;
    page.near_scale = page.time_scale = 1.0;
    page.segments.resize(1);
    page.segments[0].t1_s = 1.0;
    page.num_segments = 1;
    call->take_answer(wire::encode(page), now_);
    call->finish(Outcome::kAnswered);
  }
  step_at(seconds(11));
  std::size_t paths = 0;
  for (const Outgoing& message : sent_) {
    EXPECT_LE(message.bytes.size(), wire::kMaxMessageBytes);
    paths += wire::decode<watch_t>(message.bytes).message.value().paths.size();
  }
  EXPECT_GE(paths, 7001u);
}

}  // namespace
}  // namespace camway
