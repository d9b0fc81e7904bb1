// SPDX-License-Identifier: MIT
#include "daemon/service/transport/outbox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/service/fake_transport.h"

namespace camway::service {
namespace {

using testing::FakeTransport;

Pages pages_of(std::size_t count, std::size_t size, std::uint8_t mark) {
  return std::make_shared<const std::vector<Bytes>>(count, Bytes(size, mark));
}

TEST(Outbox, SendsAFewPagesAtATime) {
  FakeTransport transport;
  Outbox outbox(transport);
  ASSERT_TRUE(outbox.add("A", pages_of(5, 60'000, 1)));
  ASSERT_TRUE(outbox.add("B", pages_of(1, 100, 2)));
  std::vector<std::size_t> sent;
  while (!outbox.empty()) {
    outbox.send_burst();
    sent.push_back(transport.published().size());
  }
  EXPECT_EQ(sent, (std::vector<std::size_t>{2, 4, 6}));
}

TEST(Outbox, ALongAnswerHoldsUpNobody) {
  FakeTransport transport;
  Outbox outbox(transport);
  ASSERT_TRUE(outbox.add("LONG", pages_of(1024, 60'000, 1)));
  outbox.send_burst();
  for (const char* const channel : {"A", "B", "C", "LONG"}) {
    ASSERT_TRUE(outbox.add(channel, pages_of(1, 100, 2)));
  }
  outbox.send_burst();
  outbox.send_burst();
  for (const char* const channel : {"A", "B", "C"}) {
    EXPECT_EQ(transport.published_on(channel).size(), 1U) << channel;
  }
  const std::vector<Bytes> on_long = transport.published_on("LONG");
  EXPECT_EQ(std::ranges::count(on_long, 100U, &Bytes::size), 1)
      << "nor do short answers wait behind it on its own channel";
}

TEST(Outbox, ChannelsGetTheSameNumberOfPages) {
  FakeTransport transport;
  Outbox outbox(transport);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(outbox.add("MANY", pages_of(3, 10'000, 1)));
  ASSERT_TRUE(outbox.add("ONE", pages_of(40, 10'000, 2)));
  while (transport.published_on("ONE").size() < 40) outbox.send_burst();
  EXPECT_NEAR(static_cast<double>(transport.published_on("MANY").size()), 40.0,
              Outbox::kBurstMessages);
}

TEST(Outbox, RefusalsTakeNoMoreThanTheirPart) {
  FakeTransport transport;
  Outbox outbox(transport, {.answers = 10, .refusals = 3});
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(
        outbox.add("STRANGER" + std::to_string(i), pages_of(1, 100, 1), {}, Outbox::Kind::kRefusal),
        i < 3);
  }
  EXPECT_EQ(outbox.dropped(), 17);
  for (int i = 0; i < 7; ++i) {
    ASSERT_TRUE(outbox.add("CLIENT" + std::to_string(i), pages_of(1, 100, 2)));
  }
  outbox.send_burst();
  EXPECT_TRUE(outbox.add("STRANGER", pages_of(1, 100, 1), {}, Outbox::Kind::kRefusal))
      << "those that were sent make room";
}

TEST(Outbox, EveryPageGoesOutOnceAndInOrder) {
  FakeTransport transport;
  Outbox outbox(transport);
  const auto numbered = [](std::size_t count) {
    std::vector<Bytes> pages;
    for (std::size_t i = 0; i < count; ++i) pages.push_back({static_cast<std::uint8_t>(i)});
    return std::make_shared<const std::vector<Bytes>>(pages);
  };
  const std::vector<std::size_t> which{5, 7, 6};
  ASSERT_TRUE(outbox.add("A", numbered(50)));
  ASSERT_TRUE(outbox.add("B", numbered(9), which));
  while (!outbox.empty()) outbox.send_burst();
  EXPECT_EQ(transport.published_on("A"), *numbered(50));
  EXPECT_EQ(transport.published_on("B"), (std::vector<Bytes>{{5}, {7}, {6}}));
}

TEST(Outbox, LimitsTheMessagesOfABurstToo) {
  FakeTransport transport;
  Outbox outbox(transport);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(outbox.add("A", pages_of(1, 10, 1)));
  outbox.send_burst();
  EXPECT_EQ(transport.published().size(), static_cast<std::size_t>(Outbox::kBurstMessages));
}

TEST(Outbox, AnAnswerThatStillWaitsIsNotQueuedAgain) {
  FakeTransport transport;
  Outbox outbox(transport);
  const Pages pages = pages_of(3, 60'000, 1);
  EXPECT_TRUE(outbox.add("A", pages));
  EXPECT_FALSE(outbox.add("A", pages));
  outbox.send_burst();
  EXPECT_FALSE(outbox.add("A", pages)) << "its third page is still to come";
  outbox.send_burst();
  EXPECT_TRUE(outbox.add("A", pages));
}

TEST(Outbox, IsBounded) {
  FakeTransport transport;
  const Outbox::Limits limits{.answers = 20, .answers_of_a_channel = 5, .bytes = 1000};
  Outbox outbox(transport, limits);
  for (std::size_t i = 0; i < limits.answers_of_a_channel; ++i) {
    ASSERT_TRUE(outbox.add("A", pages_of(1, 1, 1)));
  }
  EXPECT_FALSE(outbox.add("A", pages_of(1, 1, 1)));
  for (std::size_t i = limits.answers_of_a_channel; i < limits.answers; ++i) {
    ASSERT_TRUE(outbox.add("B" + std::to_string(i), pages_of(1, 1, 1)));
  }
  EXPECT_FALSE(outbox.add("C", pages_of(1, 1, 1)));
  EXPECT_EQ(outbox.dropped(), 2);
  while (!outbox.empty()) outbox.send_burst();
  EXPECT_TRUE(outbox.add("A", pages_of(5, 500, 1))) << "alone it may be larger than the limit";
  EXPECT_FALSE(outbox.add("B", pages_of(1, 1, 1)));
  while (!outbox.empty()) outbox.send_burst();
  EXPECT_TRUE(outbox.add("B", pages_of(1, 600, 1)));
  EXPECT_TRUE(outbox.add("C", pages_of(2, 200, 1)));
  EXPECT_FALSE(outbox.add("D", pages_of(1, 1, 1)));
}

TEST(Outbox, WhatTheTransportRefusesIsLost) {
  FakeTransport transport;
  transport.fail_publish();
  Outbox outbox(transport);
  ASSERT_TRUE(outbox.add("A", pages_of(2, 10, 1)));
  outbox.send_burst();
  EXPECT_TRUE(outbox.empty());
}

}  // namespace
}  // namespace camway::service
