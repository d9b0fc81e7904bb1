// SPDX-License-Identifier: MIT
#include "daemon/service/outbox.h"

#include <gtest/gtest.h>

#include "tests/service/fake_transport.h"

namespace camway::service {
namespace {

using testing::FakeTransport;

Pages pages_of(std::size_t count, std::size_t size, std::uint8_t mark) {
  return std::make_shared<const std::vector<Bytes>>(count, Bytes(size, mark));
}

TEST(Outbox, SendsAnswersInOrderAFewPagesAtATime) {
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
  EXPECT_EQ(transport.published().back().channel, "B");
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
  Outbox outbox(transport);
  for (std::size_t i = 0; i < Outbox::kCapacity; ++i) {
    ASSERT_TRUE(outbox.add("A", pages_of(1, 1, 1)));
  }
  EXPECT_FALSE(outbox.add("A", pages_of(1, 1, 1)));
}

TEST(Outbox, CountsWhatTheTransportRefuses) {
  FakeTransport transport;
  transport.fail_publish();
  Outbox outbox(transport);
  ASSERT_TRUE(outbox.add("A", pages_of(2, 10, 1)));
  outbox.send_burst();
  EXPECT_TRUE(outbox.empty());
  EXPECT_EQ(outbox.failed(), 2U);
}

}  // namespace
}  // namespace camway::service
