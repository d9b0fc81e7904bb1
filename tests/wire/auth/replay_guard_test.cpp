// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/auth/replay_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include "tests/support/random.h"

namespace camway::wire {
namespace {

using Verdict = ReplayGuard::Verdict;

constexpr std::uint64_t kReplaySeed = 20261122;
constexpr std::int64_t kNow = 1'800'000'000'000'000;
constexpr std::int64_t kWindow = 30'000'000;

ReplayGuard::Limits open_limits() { return {.window_us = kWindow, .only_since_start = false}; }

envelope_t message(std::int64_t counter, std::int64_t utime = kNow, std::int64_t sender = 7) {
  envelope_t envelope{};
  envelope.key_id = 1;
  envelope.sender = sender;
  envelope.counter = counter;
  envelope.utime = utime;
  return envelope;
}

TEST(ReplayGuard, NothingIsNewTwiceHoweverMessagesOvertakeEachOther) {
  testing::Random random(kReplaySeed);
  ReplayGuard guard(open_limits(), kNow);
  std::set<std::int64_t> taken;
  std::int64_t front = 0;
  for (int trial = 0; trial < 200'000; ++trial) {
    front += static_cast<std::int64_t>(random() % 3);
    // Mostly near the highest counter; sometimes far ahead or behind.
    const auto back = static_cast<std::int64_t>(random() % 2000);
    const std::int64_t counter = front - back;
    const Verdict verdict = guard.take(message(counter), kNow);
    if (verdict == Verdict::kNew) {
      ASSERT_TRUE(taken.insert(counter).second) << "number " << counter;
    } else {
      ASSERT_EQ(verdict, Verdict::kReplayed);
      const std::int64_t highest = *taken.rbegin();
      ASSERT_TRUE(taken.count(counter) == 1 ||
                  highest - counter >= static_cast<std::int64_t>(ReplayGuard::kReordered))
          << "a new one was refused: " << counter << " below " << highest;
    }
  }
}

TEST(ReplayGuard, TheWindowIncludesBothItsEnds) {
  std::int64_t counter = 0;
  ReplayGuard guard(open_limits(), kNow);
  for (const std::int64_t good : {kNow - kWindow, kNow, kNow + kWindow}) {
    EXPECT_EQ(guard.take(message(++counter, good), kNow), Verdict::kNew);
  }
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t bad : {kNow - kWindow - 1, kNow + kWindow + 1, kLeast, kMost}) {
    EXPECT_EQ(guard.take(message(++counter, bad), kNow), Verdict::kStale);
  }
}

TEST(ReplayGuard, WhatIsFromBeforeTheStartIsStaleWhereThatCounts) {
  ReplayGuard guard({.window_us = kWindow, .only_since_start = true}, kNow);
  EXPECT_EQ(guard.take(message(1, kNow - 1), kNow), Verdict::kStale);
  EXPECT_EQ(guard.take(message(2, kNow), kNow), Verdict::kNew);
}

TEST(ReplayGuard, CountersAtTheEndsOfTheirRangeAreJustNumbers) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  ReplayGuard guard(open_limits(), kNow);
  EXPECT_EQ(guard.take(message(kLeast), kNow), Verdict::kNew);
  EXPECT_EQ(guard.take(message(kLeast), kNow), Verdict::kReplayed);
  EXPECT_EQ(guard.take(message(kMost), kNow), Verdict::kNew);
  EXPECT_EQ(guard.take(message(kLeast), kNow), Verdict::kReplayed);
  EXPECT_EQ(guard.take(message(kMost), kNow), Verdict::kReplayed);
}

TEST(ReplayGuard, RemembersABoundedNumberOfSendersAndForgetsTheSilentOnly) {
  ReplayGuard::Limits limits = open_limits();
  limits.senders = 10;
  ReplayGuard guard(limits, kNow);
  for (std::int64_t sender = 0; sender < 10; ++sender) {
    EXPECT_EQ(guard.take(message(1, kNow + sender, sender), kNow), Verdict::kNew);
  }
  EXPECT_EQ(guard.take(message(1, kNow, 10), kNow), Verdict::kCrowded);
  EXPECT_EQ(guard.senders(), 10U);
  // Then the first three have been silent for longer than their messages are accepted.
  const std::int64_t later = kNow + kWindow + 3;
  EXPECT_EQ(guard.take(message(1, later, 10), later), Verdict::kNew);
  EXPECT_EQ(guard.senders(), 8U);
  for (std::int64_t sender = 0; sender < 10; ++sender) {
    EXPECT_NE(guard.take(message(1, kNow + sender, sender), later), Verdict::kNew) << sender;
  }
}

TEST(ReplayGuard, SendersAndKeysHaveNumbersOfTheirOwn) {
  ReplayGuard guard(open_limits(), kNow);
  EXPECT_EQ(guard.take(message(1, kNow, 1), kNow), Verdict::kNew);
  EXPECT_EQ(guard.take(message(1, kNow, 2), kNow), Verdict::kNew);
  envelope_t other_key = message(1, kNow, 1);
  other_key.key_id = 2;
  EXPECT_EQ(guard.take(other_key, kNow), Verdict::kNew);
}

}  // namespace
}  // namespace camway::wire
