// SPDX-License-Identifier: MIT
#include "client/engine/retry.h"

#include <gtest/gtest.h>

#include <vector>

namespace camway {
namespace {

using Action = Retry::Action;
using std::chrono::milliseconds;
using std::chrono::seconds;

const Clock::time_point kStart = Clock::now();
constexpr Retry::Rules kRules{1.0, 2.0, 5.0, 0.0, 3};

/// Runs a request that nothing answers. Holds the times at which it is sent, and what ends it.
struct History {
  std::vector<double> sent_s;
  Action end;
};
History run(Retry retry, bool alive = false) {
  History history{};
  Clock::time_point now = kStart;
  for (;;) {
    switch (const Action action = retry.next(now)) {
      case Action::kSend:
        history.sent_s.push_back(std::chrono::duration<double>(now - kStart).count());
        break;
      case Action::kWait:
        now = retry.wake();
        if (alive) retry.note_life();
        break;
      default:
        history.end = action;
        return history;
    }
  }
}

TEST(Retry, WaitsLongerAndLongerAndGivesUpInSilence) {
  const History lonely = run(Retry(kRules, kStart + seconds(100), 1));
  EXPECT_EQ(lonely.sent_s, (std::vector<double>{0, 1, 3, 7}));
  EXPECT_EQ(lonely.end, Action::kSilence);
}

TEST(Retry, IsGivenUpWhereNobodyIsEverHeard) {
  Retry::Rules rules = kRules;
  rules.retries = 1000;
  rules.silence_s = 4.0;
  const History lonely = run(Retry(rules, kStart + seconds(100), 1));
  EXPECT_EQ(lonely.sent_s, (std::vector<double>{0, 1, 3}));
  EXPECT_EQ(lonely.end, Action::kSilence);
  const History alive = run(Retry(rules, kStart + seconds(20), 1), true);
  EXPECT_EQ(alive.end, Action::kDeadline);
}

TEST(Retry, GoesOnToTheDeadlineWhereSomebodyLives) {
  const History alive = run(Retry(kRules, kStart + seconds(20), 1), true);
  EXPECT_EQ(alive.sent_s, (std::vector<double>{0, 1, 3, 7, 12, 17}));
  EXPECT_EQ(alive.end, Action::kDeadline);
}

TEST(Retry, JitterBlursTheWaitsByItsShareAndDependsOnTheSeed) {
  Retry::Rules rules = kRules;
  rules.jitter = 0.2;
  const std::vector<double> a = run(Retry(rules, kStart + seconds(100), 1)).sent_s;
  const std::vector<double> b = run(Retry(rules, kStart + seconds(100), 2)).sent_s;
  EXPECT_EQ(a, run(Retry(rules, kStart + seconds(100), 1)).sent_s);
  EXPECT_NE(a, b);
  for (const auto& sent : {a, b}) {
    ASSERT_EQ(sent.size(), 4u);
    for (std::size_t i = 1; i < sent.size(); ++i) {
      const double wait_s = double(1 << (i - 1));
      EXPECT_NEAR(sent[i] - sent[i - 1], wait_s, 0.2 * wait_s + 1e-6);
    }
  }
}

TEST(Retry, AsksForWhatIsMissingBeforeItAsksForAll) {
  Retry retry(kRules, kStart + seconds(100), 1);
  EXPECT_EQ(retry.next(kStart), Action::kSend);
  retry.note_part(kStart + milliseconds(10));
  EXPECT_EQ(retry.next(kStart + milliseconds(11)), Action::kWait) << "more may be on its way";
  std::vector<Action> actions;
  Clock::time_point now = kStart;
  while (actions.empty() || actions.back() != Action::kSend) {
    now = retry.wake();
    actions.push_back(retry.next(now));
    ASSERT_LT(actions.size(), 10u);
  }
  EXPECT_EQ(actions,
            (std::vector<Action>{Action::kAskMissing, Action::kAskMissing, Action::kSend}));
  EXPECT_LT(now, kStart + seconds(1)) << "sooner than if nothing had come";
}

TEST(Retry, SendsAgainAtOnceToADaemonThatCannotHaveHeard) {
  Retry retry(kRules, kStart + seconds(100), 1);
  EXPECT_EQ(retry.next(kStart), Action::kSend);
  const Clock::time_point now = kStart + milliseconds(500);
  retry.note_heartbeat(20.0, now);
  EXPECT_EQ(retry.next(now), Action::kWait);
  retry.note_heartbeat(0.4, now);
  EXPECT_EQ(retry.next(now), Action::kSend);
  EXPECT_EQ(retry.tries(), 2);
  EXPECT_EQ(retry.next(now), Action::kWait) << "once";
}

TEST(Retry, GivesUpADaemonThatEndsUnlessAnotherIsHeard) {
  Retry::Rules rules = kRules;
  rules.successor_wait_s = 1.5;
  Retry retry(rules, kStart + seconds(100), 1);
  EXPECT_EQ(retry.next(kStart), Action::kSend);
  retry.note_stopping(kStart + milliseconds(200));
  retry.note_stopping(kStart + milliseconds(900));  // again, as the request was repeated
  Clock::time_point now = kStart + milliseconds(200);
  while (retry.next(now) != Action::kSilence) now = retry.wake();
  EXPECT_EQ(now, kStart + milliseconds(1700));

  Retry lucky(rules, kStart + seconds(100), 1);
  EXPECT_EQ(lucky.next(kStart), Action::kSend);
  lucky.note_stopping(kStart + milliseconds(200));
  lucky.note_heartbeat(0.1, kStart + milliseconds(1000));
  EXPECT_EQ(lucky.next(kStart + milliseconds(1000)), Action::kSend);
  EXPECT_EQ(lucky.next(kStart + milliseconds(1750)), Action::kWait);

  Retry patient(kRules, kStart + seconds(100), 1);
  EXPECT_EQ(patient.next(kStart), Action::kSend);
  patient.note_stopping(kStart + milliseconds(200));
  EXPECT_EQ(patient.next(kStart + milliseconds(900)), Action::kWait);
  EXPECT_EQ(patient.next(kStart + seconds(2)), Action::kSend) << "as long as the retries last";
}

TEST(Retry, AnotherRequestIsSentAtOnceAndAsPatiently) {
  Retry retry(kRules, kStart + seconds(100), 1);
  Clock::time_point now = kStart;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(retry.next(now), Action::kSend);
    EXPECT_EQ(retry.next(now), Action::kWait);
    now = retry.wake();
  }
  now -= milliseconds(500);
  retry.restart();
  EXPECT_EQ(retry.next(now), Action::kSend);
  EXPECT_EQ(retry.next(now), Action::kWait);
  EXPECT_EQ(retry.wake(), now + seconds(1));
}

TEST(Retry, ARequestWithLittleTimeIsRepeatedWithinIt) {
  Retry retry(kRules, kStart + seconds(100), 1);
  EXPECT_EQ(retry.next(kStart), Action::kSend);
  const Clock::time_point now = kStart + milliseconds(500);
  retry.restart_within(1.0, now);
  EXPECT_EQ(retry.next(now), Action::kSend);
  EXPECT_EQ(retry.next(now), Action::kWait);
  EXPECT_EQ(retry.next(retry.wake()), Action::kSend) << "the first may be lost";
  EXPECT_LT(retry.wake(), now + seconds(1));
  retry.note_life();
  EXPECT_EQ(retry.next(now + seconds(1)), Action::kDeadline) << "even where a daemon lives";
  retry = Retry(kRules, now + milliseconds(100), 1);
  retry.restart_within(1.0, now);
  EXPECT_EQ(retry.next(now), Action::kSend);
  EXPECT_EQ(retry.next(now + milliseconds(100)), Action::kDeadline) << "an earlier one counts";
}

}  // namespace
}  // namespace camway
